// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/wake.h"

#include <algorithm>

#include "physics/stages/stages.h"
#include "physics/state/share_awake.h"

namespace embody::physics::stages {

namespace {

// The pairs that touched when they fell asleep still do: no event begins or ends.
void add_touching(std::vector<TouchingPair>& touching, const WorldState& world, const std::vector<Contact>& contacts) {
    for (const Contact& c : contacts) {
        if (is_touching(c)) touching.push_back({world.bodies.handle_at(c.a), world.bodies.handle_at(c.b)});
    }
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
}

// Walks through all bodies: only where the set has changed, so that sleepers cost nothing.
void list_awake(WorldState& world) {
    world.awake_changed = false;
    ++world.awake_version;
    world.awake.clear();
    world.asleep_when_gathered = 0;
    for (std::uint32_t body = 0; body < world.bodies.slot_count(); ++body) {
        if (!world.is_used(body) || !world.record(body).definition.enabled) continue;
        if (world.record(body).definition.kind == BodyKind::static_body) continue;
        if (world.is_asleep(body)) {
            ++world.asleep_when_gathered;
        } else {
            world.awake.push_back(body);
        }
    }
}

// ½ ρ c A |u| u of the air that goes by with velocity u, held back so that in one step it takes away no more than all:
// alone it has u go to u/(1 + k |u| h), which is exact, with k = ρ c A/2m.
Vec3 drag_of_air(const WorldState& world, std::uint32_t body, const Wind& wind) {
    const double half_density_area = world.settings.air_density / 2 * world.record(body).definition.drag_area;
    const Vec3 u = wind.at(world.motion[body].center) - world.motion[body].linear_velocity;
    const double strength = half_density_area * length(u);
    return (strength / (1 + strength * world.motion[body].inverse_mass * world.settings.time_step)) * u;
}

// Sleepers that the wind pushes otherwise than when they fell asleep: each is asked four times a second at 60 Hz.
void wake_by_wind(WorldState& world, const Wind& wind) {
    constexpr double noticed_change = 0.05;  // of the weight
    constexpr std::uint32_t turns = 15;
    const auto first = static_cast<std::uint32_t>(world.report.step % turns);
    for (std::uint32_t body = first; body < world.bodies.slot_count(); body += turns) {
        if (!world.is_used(body) || !world.is_asleep(body) || !world.is_dynamic(body)) continue;
        const BodyRecord& record = world.record(body);
        if (!(record.definition.drag_area > 0)) continue;
        const double weight = world.constants[body].mass * length(world.settings.gravity);
        if (length(drag_of_air(world, body, wind) - record.drag) > noticed_change * weight)
            world.to_wake.push_back(body);
    }
}

// Gravity and forces of the coming step.
void refresh_forces(WorldState& world, std::uint32_t body, const Wind& wind) {
    BodyRecord& record = world.record(body);
    if (world.deformables.count() > 0) {
        record.start_linear_velocity = world.motion[body].linear_velocity;
        record.start_angular_velocity = world.motion[body].angular_velocity;
    }
    BodyConstants& constants = world.constants[body];
    const double inverse_mass = world.motion[body].inverse_mass;
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

void wake_group_of(WorldState& world, std::uint32_t body) {
    if (!world.is_asleep(body)) return;
    world.awake_changed = true;
    const auto found = world.sleepers.find(world.sleep[body].group);
    for (const std::uint32_t member : found->second.bodies) {
        SleepRecord& record = world.sleep[member];
        record.state = SleepState::active;
        record.quiet_time = 0;
        world.sleep_events.push_back(
            {SleepEvent::Kind::woke, world.bodies.handle_at(member), world.record(member).definition.user_data});
    }
    add_touching(world.touching, world, found->second.contacts);
    world.touch_memory.is_laid_out = false;
    auto& contacts = world.contacts;
    contacts.insert(contacts.end(), found->second.contacts.begin(), found->second.contacts.end());
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b) { return contact_key(a) < contact_key(b); });
    world.sleepers.erase(found);
}

// While no step comes the same bodies may be named again and again, by hands that move them.
void wake_later(WorldState& world, std::uint32_t body) {
    world.to_wake.push_back(body);
    const std::size_t most = 2 * std::size_t{world.bodies.slot_count()} + 64;
    if (world.to_wake.size() < most) return;
    std::vector<bool> is_named(world.bodies.slot_count());
    std::erase_if(world.to_wake, [&](std::uint32_t slot) {
        if (slot >= is_named.size() || is_named[slot]) return true;
        is_named[slot] = true;
        return false;
    });
}

std::vector<bool> marked(const WorldState& world, std::span<const std::uint32_t> bodies) {
    std::vector<bool> is_meant(world.bodies.slot_count());
    for (const std::uint32_t body : bodies) is_meant[body] = true;
    return is_meant;
}

void wake_around(WorldState& world, std::uint32_t body) { wake_around(world, std::span(&body, 1)); }

void wake_touching(WorldState& world, std::uint32_t body) {
    wake_later(world, body);
    // What is awake sleeps no sooner than the body beside it: the search is for sleepers alone. Without them a scene of
    // 100,000 bodies would be sorted again for each that is added.
    if (!world.record(body).shape || world.sleepers.empty()) return;
    const Bounds bounds = enlarged(world.record(body).shape->bounds(world.pose(body)), 0.01);
    world.broad_phase.query(bounds, [&](std::uint32_t other) {
        world.sleep[other].quiet_time = 0;
        if (world.is_asleep(other)) wake_later(world, other);
    });
}

void wake_around(WorldState& world, std::span<const std::uint32_t> bodies) {
    for (const std::uint32_t body : bodies) wake_touching(world, body);

    // Of several bodies in one walk over the joints.
    const std::vector<bool> is_one = bodies.size() > 1 ? marked(world, bodies) : std::vector<bool>{};
    const auto is_meant = [&](std::uint32_t body) { return is_one.empty() ? body == bodies[0] : is_one[body]; };
    for (std::uint32_t i = 0; i < world.joints.slot_count() && !bodies.empty(); ++i) {
        if (!world.joints.used(i)) continue;
        const JointDefinition& joint = world.joints.at(i).definition;
        if (!is_meant(joint.body_b.index) && (joint.body_a.is_null() || !is_meant(joint.body_a.index))) continue;
        wake_later(world, joint.body_b.index);
        if (!joint.body_a.is_null()) wake_later(world, joint.body_a.index);
    }
}

void wake_bodies(WorldState& world) {
    world.sleep_events.clear();
    if (world.settings.wind != Vec3{}) wake_by_wind(world, world.wind());
    for (const std::uint32_t body : world.to_wake) {
        if (world.is_used(body) && world.is_asleep(body)) wake_group_of(world, body);
        if (world.is_used(body)) world.sleep[body].quiet_time = 0;
    }
    world.to_wake.clear();
    gather_awake(world);
    limit_speeds(world);
}

void gather_awake(WorldState& world) {
    if (world.awake_changed) list_awake(world);
    const Wind wind = world.wind();
    for_each_awake(world, [&](std::uint32_t body) {
        if (world.is_dynamic(body)) refresh_forces(world, body, wind);
    });
}

}  // namespace embody::physics::stages
