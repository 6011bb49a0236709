// SPDX-License-Identifier: MIT
//
// Sleeping policy of the paper, section IV: the kinetic energy is one measure for linear and angular motion; scaled by
// the mass, so that one threshold serves light and heavy bodies; tracked over several steps, because a slow body may
// pass through rest. A whole island sleeps or none of it: a body asleep among moving ones would have to be woken at
// once.
//
// Rest is a balance of forces, not slowness: a pendulum at its turning point and a ball that begins to roll are slow.
// The net force is measured by its effect: a body under the acceleration a leaves each place at which it was slow by at
// least a T²/8 in the time T, so a body that stays within a sixtieth of the travel that its threshold allows is in
// balance to 8/60 v/T (0.008 m/s² by default).
#include "physics/optimization/island_sleep.h"

#include <algorithm>
#include <cmath>

#include "physics/dynamic/conserved.h"

namespace embody::physics::optimization {

namespace {

// Whether a surface point has moved farther than `travel` since the quiet time began.
bool has_moved_on(const SleepRecord& record, const BodyState& state, double reach, double travel) {
    const Quat turn = state.rotation * conjugate(record.quiet_rotation);
    const double chord = 2 * length(Vec3{turn.x, turn.y, turn.z}) * reach;
    return distance(state.center, record.quiet_center) + chord > travel;
}

}  // namespace

void track_quietness(SleepRecord& record, const BodyState& state, const BodyConstants& constants, double reach,
                     const QuietRules& rules) {
    const double energy_per_mass = kinetic_energy(state, constants) / constants.mass;
    const bool is_quiet = record.allowed && energy_per_mass <= record.threshold;
    record.state = is_quiet ? SleepState::wants_to_sleep : SleepState::active;
    const double travel = rules.travel_fraction * std::sqrt(2 * record.threshold) * rules.time_to_sleep;
    if (!is_quiet) {
        record.quiet_time = 0;
    } else if (record.quiet_time == 0 || (!rules.may_move_on && has_moved_on(record, state, reach, travel))) {
        record.quiet_time = rules.time_step;
        record.quiet_center = state.center;
        record.quiet_rotation = state.rotation;
    } else {
        record.quiet_time += rules.time_step;
    }
}

bool may_sleep(std::span<const std::uint32_t> bodies, std::span<const SleepRecord> records, double time_to_sleep) {
    return std::all_of(bodies.begin(), bodies.end(),
                       [&](std::uint32_t body) { return records[body].quiet_time >= time_to_sleep; });
}

}  // namespace embody::physics::optimization
