// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "physics/definitions/field_check.h"
#include "physics/inter/world.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;
using namespace stages;

namespace {

Error stale_body() { return {"body", "is not a body of this world"}; }

Result<std::vector<std::uint32_t>> slots_of(const WorldState& world, std::span<const BodyHandle> bodies) {
    std::vector<std::uint32_t> slots;
    slots.reserve(bodies.size());
    for (const BodyHandle body : bodies) {
        if (!world.rigid.bodies.contains(body)) return stale_body();
        slots.push_back(body.index);
    }
    return slots;
}

// Counts the users of a shape, so that it is not destroyed while a body has it.
void change_users(WorldState& world, ShapeHandle shape, int change) {
    if (ShapeRecord* record = world.rigid.shapes.find(shape)) record->users += static_cast<std::uint32_t>(change);
}

void remove_joints_of(WorldState& world, std::span<const std::uint32_t> bodies) {
    std::vector<bool> is_meant;
    bool any_removed = false;
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        if (is_meant.empty()) is_meant = marked(world.rigid, bodies);
        const JointDefinition& joint = world.joints.records.at(slot).definition;
        if (!is_meant[joint.body_b.index] && (joint.body_a.is_null() || !is_meant[joint.body_a.index])) continue;
        world.joints.records.remove(world.joints.records.handle_at(slot));
        any_removed = true;
    }
    if (any_removed) list_jointed_pairs(world.joints);
}

// Joints keep their frames relative to the centre of mass, which a new definition may move.
void set_up_joints_of(WorldState& world, BodyHandle body) {
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        JointRecord& record = world.joints.records.at(slot);
        if (record.definition.body_a != body && record.definition.body_b != body) continue;
        if (auto joint = set_up_joint(world.rigid, record.definition)) record.constraint = std::move(joint).value();
    }
}

}  // namespace

Result<BodyHandle> World::create_body(const BodyDefinition& definition) {
    auto setup = set_up_body(state_->rigid, definition);
    if (!setup) return setup.error();
    const BodyHandle handle = state_->rigid.bodies.insert({});
    place_body(WakeAccess(*state_), state_->impacts, handle.index, std::move(setup).value());
    change_users(*state_, definition.shape, 1);
    return handle;
}

Result<void> World::destroy_body(BodyHandle body) { return destroy_bodies({&body, 1}); }

Result<void> World::destroy_bodies(std::span<const BodyHandle> bodies) {
    const auto slots = slots_of(*state_, bodies);
    if (!slots) return slots.error();
    lift_bodies(WakeAccess(*state_), slots.value());
    remove_joints_of(*state_, slots.value());
    for (const BodyHandle body : bodies) {
        change_users(*state_, state_->rigid.record(body.index).definition.shape, -1);
        state_->rigid.motion[body.index] = {};
        state_->rigid.brittle.erase(body.index);
        state_->rigid.bodies.remove(body);
    }
    return {};
}

bool World::contains(BodyHandle body) const { return state_->rigid.bodies.contains(body); }

std::vector<BodyHandle> World::bodies() const {
    std::vector<BodyHandle> handles;
    for (std::uint32_t slot = 0; slot < state_->rigid.bodies.slot_count(); ++slot) {
        if (state_->rigid.bodies.used(slot)) handles.push_back(state_->rigid.bodies.handle_at(slot));
    }
    return handles;
}

std::optional<BodyDefinition> World::body(BodyHandle body) const {
    if (!contains(body)) return std::nullopt;
    return current_definition(state_->rigid, state_->activity, body.index);
}

Result<void> World::set_body(BodyHandle body, const BodyDefinition& definition) {
    return change_bodies({&body, 1}, [&](BodyDefinition& present) { present = definition; });
}

Result<void> World::change_bodies(std::span<const BodyHandle> bodies,
                                  const std::function<void(BodyDefinition&)>& change) {
    const auto slots = slots_of(*state_, bodies);
    if (!slots) return slots.error();
    std::vector<BodySetup> setups;
    setups.reserve(bodies.size());
    for (const BodyHandle body : bodies) {
        BodyDefinition definition = current_definition(state_->rigid, state_->activity, body.index);
        change(definition);
        auto setup = set_up_body(state_->rigid, definition);
        if (!setup) return setup.error();
        setups.push_back(std::move(setup).value());
    }
    lift_bodies(WakeAccess(*state_), slots.value());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const ShapeHandle shape = setups[i].record.definition.shape;
        change_users(*state_, state_->rigid.record(bodies[i].index).definition.shape, -1);
        place_body(WakeAccess(*state_), state_->impacts, bodies[i].index, std::move(setups[i]));
        change_users(*state_, shape, 1);
        set_up_joints_of(*state_, bodies[i]);
    }
    return {};
}

Transform World::pose(BodyHandle body) const { return contains(body) ? state_->rigid.pose(body.index) : Transform{}; }

Vec3 World::linear_velocity(BodyHandle body) const {
    return contains(body) ? state_->rigid.motion[body.index].linear_velocity : Vec3{};
}

Vec3 World::angular_velocity(BodyHandle body) const {
    return contains(body) ? state_->rigid.motion[body.index].angular_velocity : Vec3{};
}

SleepState World::sleep_state(BodyHandle body) const {
    return contains(body) ? state_->activity.sleep[body.index].state : SleepState::asleep;
}

double World::mass(BodyHandle body) const {
    const bool is_movable = contains(body) && state_->rigid.is_dynamic(body.index);
    return is_movable ? state_->rigid.constants[body.index].mass : std::numeric_limits<double>::infinity();
}

Vec3 World::center_of_mass(BodyHandle body) const {
    return contains(body) ? state_->rigid.motion[body.index].center : Vec3{};
}

Mat3 World::inertia(BodyHandle body) const {
    return contains(body) ? state_->rigid.constants[body.index].inertia : Mat3::zero();
}

Result<void> World::set_pose(BodyHandle body, const Transform& pose) {
    if (!contains(body)) return stale_body();
    auto result = first_error(check_vector("pose.position", pose.position, largest_coordinate, "m"),
                              check_rotation("pose.rotation", pose.rotation));
    if (!result) return result;
    BodyDefinition definition = current_definition(state_->rigid, state_->activity, body.index);
    definition.position = pose.position;
    definition.rotation = pose.rotation;
    definition.start_asleep = false;
    return set_body(body, definition);
}

Result<void> World::set_velocity(BodyHandle body, Vec3 linear, Vec3 angular) {
    if (!contains(body)) return stale_body();
    auto result = first_error(check_vector("linear", linear, largest_linear_speed, "m/s"),
                              check_vector("angular", angular, largest_angular_speed, "rad/s"));
    if (!result) return result;
    if (state_->rigid.record(body.index).definition.kind == BodyKind::static_body) {
        return Error{"body", "is static and has no velocity"};
    }
    wake_around(WakeAccess(*state_), body.index);
    wake_group_of(WakeAccess(*state_), body.index);
    state_->rigid.motion[body.index].linear_velocity = linear;
    state_->rigid.motion[body.index].angular_velocity = angular;
    return {};
}

Result<void> World::set_force(BodyHandle body, Vec3 force, Vec3 torque) {
    if (!contains(body)) return stale_body();
    auto result = first_error(check_vector("force", force, largest_force, "N"),
                              check_vector("torque", torque, largest_force, "N m"));
    if (!result) return result;
    state_->rigid.record(body.index).definition.force = force;
    state_->rigid.record(body.index).definition.torque = torque;
    wake_later(state_->activity, body.index);
    return {};
}

Result<void> World::apply_impulse(BodyHandle body, Vec3 impulse, std::optional<Vec3> at_world_point) {
    if (!contains(body)) return stale_body();
    auto result = check_vector("impulse", impulse, largest_force, "N s");
    if (result && at_world_point) {
        result = check_vector("at_world_point", *at_world_point, largest_coordinate, "m");
    }
    if (!result) return result;
    BodyState& motion = state_->rigid.motion[body.index];
    const Vec3 arm = at_world_point ? *at_world_point - motion.center : Vec3{};
    wake_group_of(WakeAccess(*state_), body.index);
    dynamic::apply_impulse(motion, impulse, arm);
    return {};
}

Result<void> World::apply_angular_impulse(BodyHandle body, Vec3 impulse) {
    if (!contains(body)) return stale_body();
    if (auto result = check_vector("impulse", impulse, largest_force, "N m s"); !result) return result;
    wake_group_of(WakeAccess(*state_), body.index);
    dynamic::apply_angular_impulse(state_->rigid.motion[body.index], impulse);
    return {};
}

Result<void> World::apply_force(BodyHandle body, Vec3 force, std::optional<Vec3> at_world_point) {
    if (!contains(body)) return stale_body();
    auto result = check_vector("force", force, largest_force, "N");
    if (result && at_world_point) {
        result = check_vector("at_world_point", *at_world_point, largest_coordinate, "m");
    }
    if (!result) return result;
    BodyRecord& record = state_->rigid.record(body.index);
    record.next_force += force;
    if (at_world_point) record.next_torque += cross(*at_world_point - state_->rigid.motion[body.index].center, force);
    wake_later(state_->activity, body.index);
    return {};
}

Result<void> World::set_enabled(BodyHandle body, bool enabled) {
    if (!contains(body)) return stale_body();
    if (state_->rigid.record(body.index).definition.enabled == enabled) return {};
    BodyDefinition definition = current_definition(state_->rigid, state_->activity, body.index);
    definition.enabled = enabled;
    return set_body(body, definition);
}

Result<void> World::wake(BodyHandle body) {
    if (!contains(body)) return stale_body();
    wake_later(state_->activity, body.index);
    return {};
}

}  // namespace embody::physics
