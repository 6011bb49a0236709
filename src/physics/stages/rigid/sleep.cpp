// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/optimization/island_sleep.h"
#include "physics/stages/stages.h"
#include "physics/state/share_awake.h"

namespace embody::physics::stages {

namespace {

// An island that a moving kinematic body carries or pushes must stay awake.
bool touches_moving_kinematic(const WorldState& world, const Island& island) {
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = world.contacts[world.islands.contacts[island.first_contact + k]];
        for (const std::uint32_t body : {contact.a, contact.b}) {
            const BodyState& state = world.motion[body];
            if (state.inverse_mass == 0 && (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{})) {
                return true;
            }
        }
    }
    return false;
}

// Moves an island's bodies and contacts out of the awake set.
void fall_asleep(WorldState& world, const Island& island, std::vector<bool>& leaves) {
    world.awake_changed = true;
    const std::uint32_t group = world.next_group++;
    SleepingGroup& sleepers = world.sleepers[group];
    for (std::uint32_t k = 0; k < island.body_count; ++k) {
        const std::uint32_t body = world.islands.bodies[island.first_body + k];
        world.motion[body].linear_velocity = world.motion[body].angular_velocity = {};
        world.sleep[body].state = SleepState::asleep;
        world.sleep[body].group = group;
        sleepers.bodies.push_back(body);
        world.sleep_events.push_back(
            {SleepEvent::Kind::fell_asleep, world.bodies.handle_at(body), world.record(body).definition.user_data});
    }
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const std::uint32_t contact = world.islands.contacts[island.first_contact + k];
        sleepers.contacts.push_back(world.contacts[contact]);
        leaves[contact] = true;
    }
    std::sort(sleepers.contacts.begin(), sleepers.contacts.end(),
              [](const Contact& a, const Contact& b) { return contact_key(a) < contact_key(b); });
}

}  // namespace

void put_to_sleep(WorldState& world) {
    const WorldSettings& settings = world.settings;
    for_each_awake(world, [&](std::uint32_t body) {
        if (world.motion[body].inverse_mass == 0) return;
        const BodyRecord& record = world.record(body);
        const QuietRules rules{settings.time_step, settings.time_to_sleep, record.deformable_force != Vec3{}};
        track_quietness(world.sleep[body], world.motion[body], world.constants[body], record.reach, rules);
    });
    if (!world.settings.sleeping) return;

    std::vector<bool> leaves;
    for (const Island& island : world.islands.list) {
        const auto bodies = std::span(world.islands.bodies).subspan(island.first_body, island.body_count);
        if (!may_sleep(bodies, world.sleep, world.settings.time_to_sleep)) continue;
        if (touches_moving_kinematic(world, island)) continue;
        leaves.resize(world.contacts.size(), false);
        fall_asleep(world, island, leaves);
    }
    if (leaves.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < world.contacts.size(); ++i) {
        if (leaves[i]) continue;
        world.contacts[kept] = world.contacts[i];
        world.contact_glances[kept++] = world.contact_glances[i];
    }
    world.contacts.resize(kept);
    world.contact_glances.resize(kept);
    world.touch_memory.is_laid_out = false;
}

}  // namespace embody::physics::stages
