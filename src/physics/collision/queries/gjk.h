// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// A corner of the Minkowski difference b - a and the two points it comes from.
struct DifferencePoint {
    Vec3 difference, on_a, on_b;
};
DifferencePoint difference_support(const Core& a, const Core& b, Vec3 direction);

/// Nearest points of two cores.
struct CoreDistance {
    bool overlap = false;
    bool is_final = true;  ///< false where the search stopped early
    double distance = 0;
    Vec3 on_a, on_b;
    Vec3 direction;  ///< along which the cores are apart, of any length; zero where they overlap
    std::array<DifferencePoint, 4> simplex;  ///< of the last iteration, where they overlap it holds the origin
    int simplex_size = 0;
};
/// May stop as soon as the gap along some direction is known to exceed `enough`: then `distance` is that gap. `start`
/// is a direction from a to b to begin with, where one is known.
CoreDistance core_distance(const Core& a, const Core& b, double enough = 1e300, Vec3 start = {},
                           double converged = 1e-12);

/// Direction in which overlapping cores separate with the shortest displacement, unit, from a to b; false if no volume
/// was found.
bool penetration_normal(const Core& a, const Core& b, const CoreDistance& overlap, Vec3& normal);

}  // namespace embody::physics::collision
