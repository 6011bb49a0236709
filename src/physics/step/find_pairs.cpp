// SPDX-License-Identifier: MIT
#include "physics/step/step.h"

namespace embody::physics {

void find_pairs(WorldState& world) {
    // Bounds of what moves, and how far it will.
    const double dt = world.settings.time_step;
    for (const std::uint32_t body : world.awake) {
        const BodyRecord& record = world.record(body);
        if (!record.shape) continue;
        const Vec3 motion =
            world.motion[body].linear_velocity * dt + world.constants[body].acceleration * (dt * dt / 2);

        // The whole way counts as bounds: what lies on it must be a pair before the body gets there.
        Bounds swept = record.shape->bounds(world.pose(body));
        swept.add(Bounds{swept.lower + motion, swept.upper + motion});
        world.broad_phase.move(body, swept, motion);
    }
    world.pairs = &world.broad_phase.update_pairs(*world.workers);
    if (world.broad_phase.has_too_many_pairs()) {
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::too_many_pairs);
    }
    world.report.pairs = static_cast<std::uint32_t>(world.pairs->size());
}

}  // namespace embody::physics
