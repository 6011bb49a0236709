// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/convex.h"

namespace embody::physics {

/// Where a corner, edge, rim or smooth side of one solid is nearest to one of the other.
struct CurveCrossing {
    Vec3 on_a, on_b;  ///< on the cores (the solids without the radius around sphere and capsule)
    Vec3 normal;      ///< unit, from a to b, across both
};

/// The nearest points of what lies farthest along `direction` (from a to b, unit, right to a few hundredths), by
/// Newton's method. A side stands for its axis with the radius around it. False where it does not converge, where the
/// two run side by side, and at the side of a cone. Whether the solids do touch there the caller has to measure.
bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing);

}  // namespace embody::physics
