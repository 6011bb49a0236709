// SPDX-License-Identifier: MIT
#include "physics/step/step.h"

namespace embody::physics {

namespace {

// Whether the velocity was above the limit.
bool limit_speed(Vec3& velocity, double most) {
    const double speed = length(velocity);
    if (!(speed > most)) return false;
    velocity *= most / speed;
    return true;
}

}  // namespace

void limit_speeds(WorldState& world) {
    for (const std::uint32_t body : world.awake) {
        if (!world.is_dynamic(body)) continue;
        BodyState& state = world.motion[body];
        if (limit_speed(state.linear_velocity, world.settings.max_linear_speed)) {
            world.report.limits |= static_cast<std::uint32_t>(StepLimit::linear_speed_clamped);
        }
        if (limit_speed(state.angular_velocity, world.settings.max_angular_speed)) {
            world.report.limits |= static_cast<std::uint32_t>(StepLimit::angular_speed_clamped);
        }
    }
}

}  // namespace embody::physics
