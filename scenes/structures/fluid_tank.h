// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"

namespace embody::scenes {

/// A tank of sloshing water with things afloat, beside a yard of boxes that fall over each other.
struct TankToFill {
    int particles = 60'000;  ///< about
    int floats = 20;         ///< boxes that float in it
    int bodies = 200;        ///< all rigid bodies that move, those afloat included
    int workers = 0;         ///< 0: as many as pay
    double seconds = 3;      ///< simulated
};

struct TankCost {
    std::size_t particles = 0;
    double fluid_ms = 0, step_ms = 0;  ///< mean a step at 60 Hz
    double worst_step_ms = 0;
    double volume_error = 0;  ///< of the mean depth at the end beside the water's volume and what floats displaces
    double draft_error = 0;   ///< mean of the floats', of their height
    std::string wrong;        ///< what the end state violates; empty: right
};

Result<TankCost> time_tank(const TankToFill& definition);

}  // namespace embody::scenes
