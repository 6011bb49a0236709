// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

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
    std::vector<double> fluid_ms, step_ms;  ///< of each step, at 60 Hz
    double volume_error = 0;  ///< of the mean depth at the end beside the water's volume and what floats displaces
    double draft_error = 0;   ///< mean of the floats' over the last second, of their height
    std::string wrong;        ///< what the end state violates; empty: right

    /// Of runs of the same tank, in which each step does the same work: the faster time of each step.
    void take_faster(const TankCost& other);
    [[nodiscard]] static double mean(const std::vector<double>& steps);
};

Result<TankCost> time_tank(const TankToFill& definition);

}  // namespace embody::scenes
