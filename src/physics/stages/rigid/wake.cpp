// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/wake.h"

#include <algorithm>

#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/deformable_state.h"
#include "physics/state/event_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// The pairs that touched when they fell asleep still do: no event begins or ends.
void add_touching(std::vector<TouchingPair>& touching, const WakeAccess& world, const std::vector<Contact>& contacts) {
    for (const Contact& c : contacts) {
        if (is_touching(c)) touching.push_back({world.rigid.bodies.handle_at(c.a), world.rigid.bodies.handle_at(c.b)});
    }
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
}

// Walks through all bodies: only where the set has changed, so that sleepers cost nothing.
void list_awake(const WakeAccess& world) {
    world.activity.awake_changed = false;
    ++world.activity.awake_version;
    world.activity.awake.clear();
    world.activity.asleep_when_gathered = 0;
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.is_used(body) || !world.rigid.record(body).definition.enabled) continue;
        if (world.rigid.record(body).definition.kind == BodyKind::static_body) continue;
        if (world.activity.is_asleep(body)) {
            ++world.activity.asleep_when_gathered;
        } else {
            world.activity.awake.push_back(body);
        }
    }
}

// ½ ρ c A |u| u of the air that goes by with velocity u, limited so that in one step it takes away at most all of u:
// alone it takes u to u/(1 + k |u| h), which is exact, with k = ρ c A/2m.
Vec3 drag_of_air(const WakeAccess& world, std::uint32_t body, const Wind& wind) {
    const double half_density_area = world.settings.air_density / 2 * world.rigid.record(body).definition.drag_area;
    const Vec3 u = wind.at(world.rigid.motion[body].center) - world.rigid.motion[body].linear_velocity;
    const double strength = half_density_area * length(u);
    return (strength / (1 + strength * world.rigid.motion[body].inverse_mass * world.settings.time_step)) * u;
}

// Sleepers on which the wind's force has changed since they fell asleep: some are checked in each step, all in turn.
void wake_by_wind(const WakeAccess& world, const Wind& wind) {
    const OptimizationSettings& settings = world.settings.solver.optimization;
    const std::uint32_t turns = settings.wake_wind_steps;
    const auto first = static_cast<std::uint32_t>(world.report.step % turns);
    for (std::uint32_t body = first; body < world.rigid.bodies.slot_count(); body += turns) {
        if (!world.rigid.is_used(body) || !world.activity.is_asleep(body) || !world.rigid.is_dynamic(body)) continue;
        const BodyRecord& record = world.rigid.record(body);
        if (!(record.definition.drag_area > 0)) continue;
        const double weight = world.rigid.constants[body].mass * length(world.settings.gravity);
        if (length(drag_of_air(world, body, wind) - record.drag) > settings.wake_force_fraction * weight)
            world.activity.to_wake.push_back(body);
    }
}

// Gravity and forces of the coming step.
void refresh_forces(const WakeAccess& world, std::uint32_t body, const Wind& wind) {
    BodyRecord& record = world.rigid.record(body);
    if (world.deformables.records.count() > 0) {
        record.start_linear_velocity = world.rigid.motion[body].linear_velocity;
        record.start_angular_velocity = world.rigid.motion[body].angular_velocity;
    }
    BodyConstants& constants = world.rigid.constants[body];
    const double inverse_mass = world.rigid.motion[body].inverse_mass;
    constants.acceleration =
        world.settings.gravity * record.definition.gravity_factor +
        (record.definition.force + record.next_force + record.deformable_force + record.fluid_force) * inverse_mass;
    if (record.definition.drag_area > 0) {
        record.drag = drag_of_air(world, body, wind);
        constants.acceleration += record.drag * inverse_mass;
    }
    constants.torque = record.definition.torque + record.next_torque + record.deformable_torque + record.fluid_torque;
}

}  // namespace

void wake_group_of(const WakeAccess& world, std::uint32_t body) {
    if (!world.activity.is_asleep(body)) return;
    world.activity.awake_changed = true;
    const auto found = world.activity.sleepers.find(world.activity.sleep[body].group);
    for (const std::uint32_t member : found->second.bodies) {
        SleepRecord& record = world.activity.sleep[member];
        record.state = SleepState::active;
        record.quiet_time = 0;
        world.events.sleep.push_back({SleepEvent::Kind::woke, world.rigid.bodies.handle_at(member),
                                      world.rigid.record(member).definition.user_data});
    }
    add_touching(world.events.touching, world, found->second.contacts);
    world.contacts.touch.is_laid_out = false;
    auto& contacts = world.contacts.list;
    contacts.insert(contacts.end(), found->second.contacts.begin(), found->second.contacts.end());
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b) { return contact_key(a) < contact_key(b); });
    world.activity.sleepers.erase(found);
}

// Between steps the same bodies may be named again and again, as a user moves them by hand.
void wake_later(ActivityState& activity, std::uint32_t body) {
    activity.to_wake.push_back(body);
    const std::size_t slots = activity.sleep.size();
    if (activity.to_wake.size() < 2 * slots + 64) return;
    std::vector<bool> is_named(slots);
    std::erase_if(activity.to_wake, [&](std::uint32_t slot) {
        if (slot >= is_named.size() || is_named[slot]) return true;
        is_named[slot] = true;
        return false;
    });
}

std::vector<bool> marked(const RigidState& rigid, std::span<const std::uint32_t> bodies) {
    std::vector<bool> is_meant(rigid.bodies.slot_count());
    for (const std::uint32_t body : bodies) is_meant[body] = true;
    return is_meant;
}

void wake_around(const WakeAccess& world, std::uint32_t body) { wake_around(world, std::span(&body, 1)); }

void wake_touching(const WakeAccess& world, std::uint32_t body) {
    wake_later(world.activity, body);
    // An awake body sleeps no sooner than the body beside it: so only sleepers are searched for. Without sleepers there
    // is no search: else a scene of 100,000 bodies would be sorted again for each body that is added.
    if (!world.rigid.record(body).shape || world.activity.sleepers.empty()) return;
    const Bounds bounds = enlarged(world.rigid.record(body).shape->bounds(world.rigid.pose(body)),
                                   world.settings.solver.optimization.wake_reach);
    world.contacts.broad_phase.query(bounds, [&](std::uint32_t other) {
        world.activity.sleep[other].quiet_time = 0;
        if (world.activity.is_asleep(other)) wake_later(world.activity, other);
    });
}

void wake_around(const WakeAccess& world, std::span<const std::uint32_t> bodies) {
    for (const std::uint32_t body : bodies) wake_touching(world, body);

    // For several bodies in one pass over the joints.
    const std::vector<bool> is_one = bodies.size() > 1 ? marked(world.rigid, bodies) : std::vector<bool>{};
    const auto is_meant = [&](std::uint32_t body) { return is_one.empty() ? body == bodies[0] : is_one[body]; };
    for (std::uint32_t i = 0; i < world.joints.records.slot_count() && !bodies.empty(); ++i) {
        if (!world.joints.records.used(i)) continue;
        const JointDefinition& joint = world.joints.records.at(i).definition;
        if (!is_meant(joint.body_b.index) && (joint.body_a.is_null() || !is_meant(joint.body_a.index))) continue;
        wake_later(world.activity, joint.body_b.index);
        if (!joint.body_a.is_null()) wake_later(world.activity, joint.body_a.index);
    }
}

void wake_bodies(const WakeAccess& world) {
    world.events.sleep.clear();
    if (world.settings.wind != Vec3{}) wake_by_wind(world, wind_at(world.settings, world.report.time));
    for (const std::uint32_t body : world.activity.to_wake) {
        if (world.rigid.is_used(body) && world.activity.is_asleep(body)) wake_group_of(world, body);
        if (world.rigid.is_used(body)) world.activity.sleep[body].quiet_time = 0;
    }
    world.activity.to_wake.clear();
    gather_awake(world);
    limit_speeds({world.settings, world.activity, world.workers, world.report, world.rigid});
}

void gather_awake(const WakeAccess& world) {
    if (world.activity.awake_changed) list_awake(world);
    const Wind wind = wind_at(world.settings, world.report.time);
    for_each_awake(world, [&](std::uint32_t body) {
        if (world.rigid.is_dynamic(body)) refresh_forces(world, body, wind);
    });
}

}  // namespace embody::physics::stages
