// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// Where a corner, edge, rim or smooth side of one solid is nearest to one of the other.
struct CurveCrossing {
    Vec3 on_a, on_b;  ///< on the cores (the solids without the radius around sphere and capsule)
    Vec3 normal;      ///< unit, from a to b, across both
    /// False where they pass each other beyond an end or run side by side: then on_a and on_b are those ends, or the
    /// middle of the common part, and no normal was found.
    bool is_within = false;
    bool is_best = false;  ///< of the solids too, if they reach farthest there: they overlap, and no normal is better
};

/// The nearest points of what lies farthest along `direction` (from a to b, unit, right to a few hundredths), by
/// Newton's method. A side stands for its axis with the radius around it. False where it does not converge, where rims
/// run side by side, and at the side of a cone. Whether the solids do touch there the caller has to measure.
bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing);

}  // namespace embody::physics::collision
