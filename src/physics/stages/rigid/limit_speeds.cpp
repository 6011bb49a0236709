// SPDX-License-Identifier: MIT
#include <atomic>

#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/stages.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// Whether the velocity was above the limit.
bool limit_speed(Vec3& velocity, double most) {
    const double speed = length(velocity);
    if (!(speed > most)) return false;
    velocity *= most / speed;
    return true;
}

}  // namespace

void limit_speeds(const SpeedAccess& world) {
    std::atomic<std::uint32_t> limits{0};
    for_each_awake(world, [&](std::uint32_t body) {
        if (!world.rigid.is_dynamic(body)) return;
        BodyState& state = world.rigid.motion[body];
        if (limit_speed(state.linear_velocity, world.settings.max_linear_speed)) {
            limits |= static_cast<std::uint32_t>(StepLimit::linear_speed_clamped);
        }
        if (limit_speed(state.angular_velocity, world.settings.max_angular_speed)) {
            limits |= static_cast<std::uint32_t>(StepLimit::angular_speed_clamped);
        }
    });
    world.report.limits |= limits;
}

}  // namespace embody::physics::stages
