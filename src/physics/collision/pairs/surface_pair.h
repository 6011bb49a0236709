// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {

struct PlacedSurface {
    const TriangleSurface& surface;
    const Transform& pose;
};

/// A convex piece against one-sided triangles: one manifold for each group of triangles that meet it with nearly the
/// same normal; piece_b is the group's lowest triangle.
void collide_surface(const ConvexPiece& piece, std::uint32_t piece_index, const Transform& pose,
                     const PlacedSurface& placed, double margin, std::vector<Manifold>& manifolds);

}  // namespace embody::physics::collision
