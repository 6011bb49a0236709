// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"

// Liquids. Each is poured into its tank, moves and is measured at the given resolution.
namespace embody::convergence {

/// Water in a tank 1 m long, 0.5 m deep on average, its surface tilted by 1 : 20 at the start.
inline constexpr double tank_length = 1, tank_depth = 0.5;
/// Period of its slowest sloshing mode along the tank, s, with so many cells along.
Result<double> period_of_sloshing(int cells);

/// A slab of 0.4 × 0.2 × 0.4 m and 400 kg/m³ on that water.
inline constexpr double slab_height = 0.2, slab_density = 400, water_density = 998;
/// Its draft at rest, m, with so many cells along the tank.
Result<double> draft_of_slab(int cells);

}  // namespace embody::convergence
