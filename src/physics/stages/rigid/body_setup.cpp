// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/body_setup.h"

#include <algorithm>
#include <utility>

#include "physics/dynamic/equations_of_motion.h"
#include "physics/dynamic/mass.h"
#include "physics/stages/access.h"
#include "physics/stages/rigid/wake.h"
#include "physics/stages/touch/pair_watch.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"
#include "physics/state/substep_memory.h"

namespace embody::physics::stages {

namespace {

Result<void> set_up_shape(const RigidState& rigid, const BodyDefinition& definition, BodySetup& setup) {
    if (definition.shape.is_null()) return {};
    const ShapeRecord* shape = rigid.shapes.find(definition.shape);
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

void remove_contacts_of(const WakeAccess& world, std::span<const std::uint32_t> bodies) {
    if (world.contacts.list.empty()) return;
    const std::vector<bool> is_meant = marked(world.rigid, bodies);
    std::erase_if(world.contacts.list, [&](const Contact& c) { return is_meant[c.a] || is_meant[c.b]; });
}

}  // namespace

Result<BodySetup> set_up_body(const RigidState& rigid, const BodyDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    BodySetup setup;
    setup.record.definition = definition;
    if (auto result = set_up_shape(rigid, definition, setup); !result) return result.error();

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

void place_body(const WakeAccess& world, ImpactMemory& impacts, std::uint32_t body, BodySetup setup) {
    world.activity.awake_changed = true;
    const std::size_t slots = world.rigid.bodies.slot_count();
    world.rigid.motion.resize(slots);
    world.rigid.constants.resize(slots);
    world.activity.sleep.resize(slots);
    world.rigid.record(body) = setup.record;
    world.rigid.record(body).version = ++world.rigid.last_body_version;
    world.rigid.constants[body] = setup.constants;
    world.rigid.motion[body] = setup.state;
    world.activity.sleep[body] = setup.sleep;
    auto& held_accelerations = impacts.held_accelerations;
    if (body < held_accelerations.size()) held_accelerations[body] = {};
    introduce_body(world.rigid, body, world.contacts.touch);

    const BodyRecord& record = world.rigid.record(body);
    const BodyDefinition& definition = record.definition;
    if (definition.brittleness && record.shape && world.rigid.is_dynamic(body))
        world.rigid.brittle.insert(body);
    else
        world.rigid.brittle.erase(body);
    if (!definition.enabled) return;
    if (record.shape) {
        world.contacts.broad_phase.insert(body, record.shape->bounds(world.rigid.pose(body)),
                                          definition.kind != BodyKind::static_body);
    }
    if (definition.start_asleep && definition.allow_sleep && world.rigid.is_dynamic(body)) {
        world.activity.sleep[body].state = SleepState::asleep;
        world.activity.sleep[body].group = world.activity.next_group;
        world.rigid.motion[body].linear_velocity = world.rigid.motion[body].angular_velocity = {};
        world.activity.sleepers[world.activity.next_group++].bodies.push_back(body);
    } else {
        wake_around(world, body);
    }
}

void lift_bodies(const WakeAccess& world, std::span<const std::uint32_t> bodies) {
    world.activity.awake_changed = true;
    // Wakes only those around these bodies: bodies named before stay listed until the next step.
    std::vector<std::uint32_t> named_before = std::exchange(world.activity.to_wake, {});
    wake_around(world, bodies);
    for (const std::uint32_t body : bodies) wake_group_of(world, body);
    for (const std::uint32_t other : world.activity.to_wake) {
        if (world.rigid.is_used(other)) wake_group_of(world, other);
    }
    named_before.swap(world.activity.to_wake);
    for (const std::uint32_t other : named_before) wake_later(world.activity, other);
    remove_contacts_of(world, bodies);
    world.contacts.summaries.clear();
    world.contacts.touch.is_laid_out = false;
    for (const std::uint32_t body : bodies) {
        if (world.rigid.record(body).shape && world.rigid.record(body).definition.enabled)
            world.contacts.broad_phase.remove(body);
    }
}

Result<void> choose_lanes(SubstepMemory& substeps, int lanes) {
    const ContactKernels* kernels = lanes == 0 ? &widest_kernels<ContactKernels>() : kernels_of<ContactKernels>(lanes);
    if (!kernels) return Error{"lanes", "are more than this processor has", "set fewer, or 0 for the most it has"};
    if (kernels->lanes != substeps.wide_solver.lanes()) substeps.wide_solver = WideContactSolver(*kernels);
    return {};
}

Result<Joint> set_up_joint(const RigidState& rigid, const JointDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    if (!rigid.bodies.contains(definition.body_b)) return Error{"body_b", "is not a body of this world"};
    const bool a_is_world = definition.body_a.is_null();
    if (!a_is_world && !rigid.bodies.contains(definition.body_a)) {
        return Error{"body_a", "is not a body of this world"};
    }
    const auto frame_about_center = [&](const Transform& frame, std::uint32_t body) {
        return Transform{frame.position - rigid.constants[body].local_center, normalized(frame.rotation)};
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

void list_jointed_pairs(JointState& joints) {
    joints.jointed_pairs.clear();
    for (std::uint32_t slot = 0; slot < joints.records.slot_count(); ++slot) {
        if (joints.records.used(slot)) add_jointed_pair(joints, joints.records.at(slot).definition);
    }
}

void add_jointed_pair(JointState& joints, const JointDefinition& joint) {
    if (joint.bodies_collide || joint.body_a.is_null()) return;
    joints.jointed_pairs.insert(std::minmax(joint.body_a.index, joint.body_b.index));
}

BodyDefinition current_definition(const RigidState& rigid, const ActivityState& activity, std::uint32_t body) {
    BodyDefinition definition = rigid.record(body).definition;
    const Transform pose = rigid.pose(body);
    definition.position = pose.position;
    definition.rotation = pose.rotation;
    definition.linear_velocity = rigid.motion[body].linear_velocity;
    definition.angular_velocity = rigid.motion[body].angular_velocity;
    definition.start_asleep = activity.is_asleep(body);
    return definition;
}

}  // namespace embody::physics::stages
