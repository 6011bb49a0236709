// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// The point where a corner, edge, rim or smooth side of one solid is nearest to one of the other.
struct CurveCrossing {
    Vec3 on_a, on_b;  ///< on the cores (the solids without the radius around sphere and capsule)
    Vec3 normal;      ///< unit, from a to b, across both
    /// False where they pass each other beyond an end or are parallel: then on_a and on_b are those ends, or the
    /// middle of the common part, and no normal was found.
    bool is_within = false;
    bool is_best = false;  ///< if the solids are farthest there: they overlap, and no normal is better
};

/// The nearest points of the features farthest along `direction` (from a to b, unit, correct to a few hundredths), by
/// Newton's method. A side is represented by its axis with the radius around it. False where it does not converge,
/// where rims are parallel, and at the side of a cone. The caller has to measure whether the solids touch there.
bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing);

}  // namespace embody::physics::collision
