// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/collision/convex.h"

namespace embody::physics {

// Loops over all vertices or faces of a polytope, two lanes at a time: the same bits on every compiler.

/// One of many and its value.
struct Extreme {
    double along = 0;
    std::uint32_t index = 0;
};

/// The largest of the dot products of `lanes` with `direction`; of equal ones the first.
Extreme farthest(const Lanes& lanes, Vec3 direction);

/// Index of the vector farthest along `direction`, as far as floats tell: another one may be farther by a few ten
/// millionths of the size.
std::uint32_t farthest_roughly(const RoughLanes& lanes, Vec3 direction);

/// heights[i] = dot(normal i, point) - reach i: how high the point is over each face. Returns the highest.
double heights_over_faces(const Polytope& polytope, Vec3 point, double* heights);

/// Lowers each bound to the height of `point` over its face; returns the highest bound then, of equal ones the first.
Extreme lower_bounds(const Polytope& polytope, Vec3 point, double* bounds);

}  // namespace embody::physics
