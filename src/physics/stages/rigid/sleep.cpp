// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/definitions/world_settings.h"
#include "physics/optimization/island_sleep.h"
#include "physics/optimization/islands.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/event_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// An island that a moving kinematic body carries or pushes must stay awake.
bool touches_moving_kinematic(const SleepAccess& world, const Island& island) {
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = world.contacts.list[world.islands.contacts[island.first_contact + k]];
        for (const std::uint32_t body : {contact.a, contact.b}) {
            const BodyState& state = world.rigid.motion[body];
            if (state.inverse_mass == 0 && (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{})) {
                return true;
            }
        }
    }
    return false;
}

// Moves an island's bodies and contacts out of the awake set.
void fall_asleep(const SleepAccess& world, const Island& island, std::vector<bool>& leaves) {
    world.activity.awake_changed = true;
    const std::uint32_t group = world.activity.next_group++;
    SleepingGroup& sleepers = world.activity.sleepers[group];
    for (std::uint32_t k = 0; k < island.body_count; ++k) {
        const std::uint32_t body = world.islands.bodies[island.first_body + k];
        world.rigid.motion[body].linear_velocity = world.rigid.motion[body].angular_velocity = {};
        world.activity.sleep[body].state = SleepState::asleep;
        world.activity.sleep[body].group = group;
        sleepers.bodies.push_back(body);
        world.events.sleep.push_back({SleepEvent::Kind::fell_asleep, world.rigid.bodies.handle_at(body),
                                      world.rigid.record(body).definition.user_data});
    }
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const std::uint32_t contact = world.islands.contacts[island.first_contact + k];
        sleepers.contacts.push_back(world.contacts.list[contact]);
        leaves[contact] = true;
    }
    std::sort(sleepers.contacts.begin(), sleepers.contacts.end(),
              [](const Contact& a, const Contact& b) { return contact_key(a) < contact_key(b); });
}

}  // namespace

void put_to_sleep(const SleepAccess& world) {
    const WorldSettings& settings = world.settings;
    for_each_awake(world, [&](std::uint32_t body) {
        if (world.rigid.motion[body].inverse_mass == 0) return;
        const BodyRecord& record = world.rigid.record(body);
        const QuietRules rules{settings.time_step, settings.time_to_sleep,
                               settings.solver.optimization.sleep_travel_fraction, record.deformable_force != Vec3{}};
        track_quietness(world.activity.sleep[body], world.rigid.motion[body], world.rigid.constants[body], record.reach,
                        rules);
    });
    if (!world.settings.sleeping) return;

    std::vector<bool> leaves;
    for (const Island& island : world.islands.list) {
        const auto bodies = std::span(world.islands.bodies).subspan(island.first_body, island.body_count);
        if (!may_sleep(bodies, world.activity.sleep, world.settings.time_to_sleep)) continue;
        if (touches_moving_kinematic(world, island)) continue;
        leaves.resize(world.contacts.list.size(), false);
        fall_asleep(world, island, leaves);
    }
    if (leaves.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < world.contacts.list.size(); ++i) {
        if (leaves[i]) continue;
        world.contacts.list[kept] = world.contacts.list[i];
        world.contacts.summaries[kept++] = world.contacts.summaries[i];
    }
    world.contacts.list.resize(kept);
    world.contacts.summaries.resize(kept);
    world.contacts.touch.is_laid_out = false;
}

}  // namespace embody::physics::stages
