// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/definitions/body_definition.h"
#include "physics/definitions/settings/optimization_settings.h"
#include "physics/dynamic/body_state.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/namespace.h"

namespace embody::physics::optimization {

/// A body's progress towards sleep.
struct SleepRecord {
    SleepState state = SleepState::active;
    double quiet_time = 0;  ///< time below its threshold and about in one place without a break, s
    Vec3 quiet_center;      ///< centre of mass when the quiet time began
    Quat quiet_rotation;
    double threshold = 0;  ///< J/kg
    bool allowed = true;
    std::uint32_t group = 0;  ///< group of sleepers; only while asleep
};

/// How long a body must stay quiet before it sleeps, and within what distance.
struct QuietRules {
    double time_step = 0;      ///< s
    double time_to_sleep = 0;  ///< s
    double travel_fraction = OptimizationSettings{}.sleep_travel_fraction;
    bool may_move_on = false;  ///< slow is enough: for what lies on soft things, whose contacts creep
};

/// Follows one body: below the threshold it becomes quiet, above it active again. A body that is slow, but moves on, is
/// not at rest: its quiet time begins anew. `reach` is the distance of its farthest surface point, m.
void track_quietness(SleepRecord& record, const BodyState& state, const BodyConstants& constants, double reach,
                     const QuietRules& rules);

/// Whether all bodies of an island have been quiet for `time_to_sleep` (s) and may sleep.
bool may_sleep(std::span<const std::uint32_t> bodies, std::span<const SleepRecord> records, double time_to_sleep);

}  // namespace embody::physics::optimization
