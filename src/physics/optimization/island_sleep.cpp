// SPDX-License-Identifier: MIT
//
// Sleeping policy of the paper, section IV: the kinetic energy is one measure for linear and angular motion; scaled by
// the mass, so that one threshold serves light and heavy bodies; tracked over several steps, because a slow body may
// pass through rest. A whole island sleeps or none of it: a body asleep among moving ones would have to be woken at
// once.
#include "physics/optimization/island_sleep.h"

#include <algorithm>

#include "physics/dynamic/conserved.h"

namespace embody::physics {

void track_quietness(SleepRecord& record, const BodyState& state, const BodyConstants& constants, double time_step) {
    const double energy_per_mass = kinetic_energy(state, constants) / constants.mass;
    const bool is_quiet = record.allowed && energy_per_mass <= record.threshold;
    record.quiet_time = is_quiet ? record.quiet_time + time_step : 0;
    record.state = is_quiet ? SleepState::wants_to_sleep : SleepState::active;
}

bool may_sleep(std::span<const std::uint32_t> bodies, std::span<const SleepRecord> records, double time_to_sleep) {
    return std::all_of(bodies.begin(), bodies.end(),
                       [&](std::uint32_t body) { return records[body].quiet_time >= time_to_sleep; });
}

}  // namespace embody::physics
