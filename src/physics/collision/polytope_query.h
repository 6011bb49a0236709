// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "physics/collision/convex.h"

namespace embody::physics {

/// One corner of a polytope and how far it reaches along a direction.
struct Extreme {
    double along = 0;
    std::uint32_t index = 0;
};

/// The largest of the dot products of `lanes` with `direction`; of equal ones the first. Sums in a fixed order: the
/// same bits whatever the compiler makes of the loops.
Extreme farthest(const Lanes& lanes, Vec3 direction);

/// heights[i] = dot(normal i, point) - reach i, for all lanes: how high the point is over each face.
void heights_over_faces(const Polytope& polytope, Vec3 point, double* heights);

}  // namespace embody::physics
