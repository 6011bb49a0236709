// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/body_setup.h"

#include <algorithm>
#include <utility>

#include "physics/dynamic/equations_of_motion.h"
#include "physics/dynamic/mass.h"
#include "physics/stages/rigid/wake.h"
#include "physics/stages/touch/pair_watch.h"

namespace embody::physics::stages {

namespace {

Result<void> set_up_shape(const WorldState& world, const BodyDefinition& definition, BodySetup& setup) {
    if (definition.shape.is_null()) return {};
    const ShapeRecord* shape = world.shapes.find(definition.shape);
    if (!shape) return Error{"shape", "is not a shape of this world"};
    setup.record.shape = shape->shape.get();
    if (definition.kind != BodyKind::static_body && is_static_only(shape->shape->definition())) {
        return Error{"shape", std::string("a ") + shape_name(shape->shape->definition()) + " can only be static"};
    }
    return {};
}

// Distances that bound how far the surface moves by turning and how thin it is.
void set_up_sizes(BodySetup& setup) {
    if (!setup.record.shape || is_static_only(setup.record.shape->definition())) return;
    const ShapeDefinition& shape = setup.record.shape->definition();
    setup.record.is_round = setup.record.shape->is_round();
    setup.record.reach = setup.record.shape->radius_about(setup.constants.local_center);
    setup.record.is_ball = std::holds_alternative<SphereShape>(shape) && setup.constants.local_center == Vec3{};
    const Vec3 half = setup.record.shape->local_bounds().half_extents();
    setup.record.inner_radius = std::min({half.x, half.y, half.z});
}

void remove_contacts_of(WorldState& world, std::span<const std::uint32_t> bodies) {
    if (world.contacts.empty()) return;
    const std::vector<bool> is_meant = marked(world, bodies);
    std::erase_if(world.contacts, [&](const Contact& c) { return is_meant[c.a] || is_meant[c.b]; });
}

}  // namespace

Result<BodySetup> set_up_body(const WorldState& world, const BodyDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    BodySetup setup;
    setup.record.definition = definition;
    if (auto result = set_up_shape(world, definition, setup); !result) return result.error();

    const bool is_dynamic = definition.kind == BodyKind::dynamic_body;
    if (is_dynamic) {
        const geometry::MassProperties none{};
        const auto& solid = setup.record.shape ? setup.record.shape->mass_properties() : none;
        if (auto result = resolve_mass(definition.mass, solid, setup.constants); !result) return result.error();
        setup.state.inverse_mass = 1 / setup.constants.mass;
    } else if (definition.mass.center_of_mass) {
        setup.constants.local_center = *definition.mass.center_of_mass;
    }
    setup.constants.linear_damping = definition.linear_damping;
    setup.constants.angular_damping = definition.angular_damping;

    BodyState& state = setup.state;
    state.rotation = normalized(definition.rotation);
    state.center = definition.position + rotate(state.rotation, setup.constants.local_center);
    if (definition.kind != BodyKind::static_body) {
        state.linear_velocity = definition.linear_velocity;
        state.angular_velocity = definition.angular_velocity;
    }
    state.start_center = state.center;
    state.start_rotation = state.rotation;
    if (is_dynamic) refresh_inertia(state, setup.constants);

    setup.record.last_center = state.center;
    setup.record.last_rotation = state.rotation;
    setup.sleep.threshold = definition.sleep_energy_per_mass;
    setup.sleep.allowed = definition.allow_sleep;
    set_up_sizes(setup);
    return setup;
}

void place_body(WorldState& world, std::uint32_t body, BodySetup setup) {
    world.awake_changed = true;
    const std::size_t slots = world.bodies.slot_count();
    world.motion.resize(slots);
    world.constants.resize(slots);
    world.sleep.resize(slots);
    world.record(body) = setup.record;
    world.record(body).version = ++world.last_body_version;
    world.constants[body] = setup.constants;
    world.motion[body] = setup.state;
    world.sleep[body] = setup.sleep;
    auto& held_accelerations = world.impact_memory.held_accelerations;
    if (body < held_accelerations.size()) held_accelerations[body] = {};
    introduce_body(world, body);

    const BodyRecord& record = world.record(body);
    const BodyDefinition& definition = record.definition;
    if (!definition.enabled) return;
    if (record.shape) {
        world.broad_phase.insert(body, record.shape->bounds(world.pose(body)),
                                 definition.kind != BodyKind::static_body);
    }
    if (definition.start_asleep && definition.allow_sleep && world.is_dynamic(body)) {
        world.sleep[body].state = SleepState::asleep;
        world.sleep[body].group = world.next_group;
        world.motion[body].linear_velocity = world.motion[body].angular_velocity = {};
        world.sleepers[world.next_group++].bodies.push_back(body);
    } else {
        wake_around(world, body);
    }
}

void lift_bodies(WorldState& world, std::span<const std::uint32_t> bodies) {
    world.awake_changed = true;
    // Only those around these bodies: who was named before keeps until the next step.
    std::vector<std::uint32_t> named_before = std::exchange(world.to_wake, {});
    wake_around(world, bodies);
    for (const std::uint32_t body : bodies) wake_group_of(world, body);
    for (const std::uint32_t other : world.to_wake) {
        if (world.is_used(other)) wake_group_of(world, other);
    }
    named_before.swap(world.to_wake);
    for (const std::uint32_t other : named_before) wake_later(world, other);
    remove_contacts_of(world, bodies);
    world.contact_glances.clear();
    world.touch_memory.is_laid_out = false;
    for (const std::uint32_t body : bodies) {
        if (world.record(body).shape && world.record(body).definition.enabled) world.broad_phase.remove(body);
    }
}

Result<void> choose_lanes(WorldState& world, int lanes) {
    const ContactKernels* kernels = lanes == 0 ? &widest_contact_kernels() : contact_kernels(lanes);
    if (!kernels) return Error{"lanes", "are more than this processor has", "set fewer, or 0 for the most it has"};
    if (kernels->lanes != world.wide_solver.lanes()) world.wide_solver = WideContactSolver(*kernels);
    return {};
}

Result<Joint> set_up_joint(const WorldState& world, const JointDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    if (!world.bodies.contains(definition.body_b)) return Error{"body_b", "is not a body of this world"};
    const bool a_is_world = definition.body_a.is_null();
    if (!a_is_world && !world.bodies.contains(definition.body_a)) {
        return Error{"body_a", "is not a body of this world"};
    }
    const auto frame_about_center = [&](const Transform& frame, std::uint32_t body) {
        return Transform{frame.position - world.constants[body].local_center, normalized(frame.rotation)};
    };
    Joint joint;
    joint.kind = definition.joint;
    joint.a_is_world = a_is_world;
    joint.b = definition.body_b.index;
    joint.local_b = frame_about_center(definition.frame_b, joint.b);
    if (a_is_world) {
        joint.local_a = {definition.frame_a.position, normalized(definition.frame_a.rotation)};
    } else {
        joint.a = definition.body_a.index;
        joint.local_a = frame_about_center(definition.frame_a, joint.a);
    }
    return joint;
}

void list_jointed_pairs(WorldState& world) {
    world.jointed_pairs.clear();
    for (std::uint32_t slot = 0; slot < world.joints.slot_count(); ++slot) {
        if (world.joints.used(slot)) add_jointed_pair(world, world.joints.at(slot).definition);
    }
}

void add_jointed_pair(WorldState& world, const JointDefinition& joint) {
    if (joint.bodies_collide || joint.body_a.is_null()) return;
    world.jointed_pairs.insert(std::minmax(joint.body_a.index, joint.body_b.index));
}

BodyDefinition current_definition(const WorldState& world, std::uint32_t body) {
    BodyDefinition definition = world.record(body).definition;
    const Transform pose = world.pose(body);
    definition.position = pose.position;
    definition.rotation = pose.rotation;
    definition.linear_velocity = world.motion[body].linear_velocity;
    definition.angular_velocity = world.motion[body].angular_velocity;
    definition.start_asleep = world.is_asleep(body);
    return definition;
}

}  // namespace embody::physics::stages
