// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/collision/shapes/convex.h"
#include "physics/collision/shapes/triangle_surface.h"

namespace embody::physics::collision {

/// A convex of a shape and its place in the shape's frame.
struct ConvexPiece {
    Convex convex;
    Transform local;
    bool is_alone = true;  ///< in the shape's frame: `local` changes nothing
};

struct CollisionShape::Data {
    ShapeDefinition definition;
    geometry::MassProperties mass;
    Bounds bounds;
    // Exactly one of the three is in use.
    std::vector<ConvexPiece> pieces;           ///< one piece, or the children of a compound
    std::vector<Bounds> piece_bounds;          ///< bounds of the pieces, in the shape's frame
    std::unique_ptr<TriangleSurface> surface;  ///< mesh and heightfield
    bool is_plane = false;
    Vec3 plane_normal;  ///< unit
    double plane_offset = 0;
};

/// Poses a piece for comparison in the frame of world axes at `origin`.
PlacedConvex place(const ConvexPiece& piece, const Transform& pose, Vec3 origin);

}  // namespace embody::physics::collision
