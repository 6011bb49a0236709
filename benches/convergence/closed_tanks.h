// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "foundation/result.h"

// Water in closed tanks for a minute: what its energy and momenta do where nothing comes in or goes out.
namespace embody::convergence {

/// One moment of a run.
struct TankMoment {
    double time = 0;      ///< s
    double energy = 0;    ///< kinetic, and in gravity that above the least there can be, of all that moves, J
    double momentum = 0;  ///< without gravity: how far the momentum of tank and water is from the first, kg m/s
    double spin = 0;      ///< without gravity: length of the angular momentum about their common centre, kg m²/s
};

struct TankRun {
    std::vector<TankMoment> moments;  ///< the first at the start
    std::size_t particles = 0, lost = 0;
    double highest = 0;       ///< largest energy of all steps, J
    double highest_gain = 0;  ///< largest rise of the energy above any earlier one, J
};

/// slosh: a tank that stands, its water heaped up to one side. free: a tank in space that tumbles with its water. land:
/// a tank that falls from half a metre, tumbling, and comes to rest.
struct ClosedTank {
    std::string_view name, what;
    Result<TankRun> (*run)(double seconds, double pause);  ///< a moment every `pause` seconds
};

std::span<const ClosedTank> closed_tanks();

}  // namespace embody::convergence
