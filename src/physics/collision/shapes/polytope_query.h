// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"
#include "physics/collision/shapes/polytope_kernels.h"

namespace embody::physics::collision {

// Loops over all vertices or faces of a polytope, as many side by side as the processor takes: the same bits on every
// one and with every compiler.

/// The largest of the dot products of `lanes` with `direction`; of equal ones the first, of none -1e300.
Extreme farthest(const Lanes& lanes, Vec3 direction);

/// The least and the largest of the dot products of `lanes` with `direction`; of none 1e300 and -1e300.
Extent extent(const Lanes& lanes, Vec3 direction);

/// Index of the vector farthest along `direction`, in single precision: another one may be farther by a few ten
/// millionths of the size.
std::uint32_t farthest_roughly(const RoughLanes& lanes, Vec3 direction);

/// heights[i] = dot(normal i, point) - reach i: how high the point is over each face. Returns the highest.
double heights_over_faces(const Polytope& polytope, Vec3 point, double* heights);

/// Lowers each bound to the height of `point` over its face; returns the highest bound then, of equal ones the first.
Extreme lower_bounds(const Polytope& polytope, Vec3 point, double* bounds);

/// Lists those of `lanes` whose dot product with `direction` is at most `limit`, ascending; the copies that fill up the
/// lanes may be among them, at the end. `found` has room for all lanes. Returns how many.
std::uint32_t find_low(const Lanes& lanes, Vec3 direction, double limit, std::uint32_t* found);

}  // namespace embody::physics::collision
