// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/convex.h"

namespace embody::physics {

/// Where an edge or rim of one solid crosses one of the other: the points on both and the normal there.
struct CurveCrossing {
    Vec3 on_a, on_b;
    Vec3 normal;  ///< unit, from a to b, across both curves
};

/// Crossing of the rims or edges that lie farthest along `direction` (from a to b, unit), by Newton steps on their
/// tangents. False where one of the two has neither there, or where they run side by side.
bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing);

}  // namespace embody::physics
