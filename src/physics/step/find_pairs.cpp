// SPDX-License-Identifier: MIT
#include "physics/step/share_awake.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

// Whether the body is as it was when the last step began (docs/physics/direct-solver.md: at rest).
bool stands(const WorldState& world, std::uint32_t body) {
    const BodyState& state = world.motion[body];
    return state.linear_velocity == Vec3{} && state.angular_velocity == Vec3{} && state.center == state.start_center &&
           state.rotation == state.start_rotation && state.inverse_mass > 0 &&
           world.constants[body].acceleration == world.touch_memory.bodies[body].acceleration &&
           world.constants[body].torque == Vec3{};
}

// Lists which of a share of the awake bodies have left their bounds, and the bounds they want.
void list_leaving(WorldState& world, Share share, std::vector<LeavingBody>& leaving) {
    const double dt = world.settings.time_step;
    for (std::size_t i = share.first; i < share.last; ++i) {
        const std::uint32_t body = world.awake[i];
        TouchBody& touch = world.touch_memory.bodies[body];
        touch.stands = stands(world, body);
        if (touch.stands) continue;
        const BodyRecord& record = world.record(body);
        if (!record.shape) continue;
        const Vec3 motion =
            world.motion[body].linear_velocity * dt + world.constants[body].acceleration * (dt * dt / 2);

        // The whole way counts as bounds: what lies on it must be a pair before the body gets there.
        Bounds swept = record.shape->bounds(world.pose(body));
        swept.add(Bounds{swept.lower + motion, swept.upper + motion});
        if (!world.broad_phase.holds(body, swept, motion)) leaving.push_back({body, swept, motion});
    }
}

}  // namespace

void find_pairs(WorldState& world) {
    // Bounds of what moves, and how far it will.
    world.leaving.resize(static_cast<std::size_t>(world.workers->workers()));
    for (std::vector<LeavingBody>& leaving : world.leaving) leaving.clear();
    share_awake(world, [&](int worker, Share share) {
        list_leaving(world, share, world.leaving[static_cast<std::size_t>(worker)]);
    });

    // In the order of the bodies, whoever looked at them.
    for (const std::vector<LeavingBody>& leaving : world.leaving) {
        for (const LeavingBody& l : leaving) world.broad_phase.move(l.body, l.bounds, l.motion);
    }
    world.pairs = &world.broad_phase.update_pairs(*world.workers);
    if (world.broad_phase.has_too_many_pairs()) {
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::too_many_pairs);
    }
    world.report.pairs = static_cast<std::uint32_t>(world.pairs->size());
}

}  // namespace embody::physics
