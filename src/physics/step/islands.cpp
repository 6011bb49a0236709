// SPDX-License-Identifier: MIT
#include "physics/optimization/islands.h"

#include "physics/dynamic/equations_of_motion.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

bool is_active(const WorldState& world, const JointDefinition& joint) {
    const auto moves = [&](std::uint32_t body) {
        return world.record(body).definition.enabled && world.is_dynamic(body) && !world.is_asleep(body);
    };
    const auto is_there = [&](std::uint32_t body) { return world.record(body).definition.enabled; };
    if (!is_there(joint.body_b.index)) return false;
    if (joint.body_a.is_null()) return moves(joint.body_b.index);
    return is_there(joint.body_a.index) && (moves(joint.body_a.index) || moves(joint.body_b.index));
}

// Contacts that need no solver: the paths of the impact stage say that the surfaces keep apart, and nothing else holds
// either body. What spins then flies free, exactly, instead of sharing the contact solver's approximate turns.
void set_idle_contacts(WorldState& world) {
    const std::vector<std::uint8_t>& is_open = world.impact_memory.is_open;
    std::vector<std::uint8_t>& is_held = world.impact_memory.is_held;
    is_held.assign(world.motion.size(), 0);
    for (std::size_t i = 0; i < world.contacts.size(); ++i) {
        const ContactGlance& contact = world.contact_glances[i];
        if (!is_open[i]) is_held[contact.a] = is_held[contact.b] = 1;
    }
    for (const Joint& joint : world.active_joints) {
        is_held[joint.b] = 1;
        if (!joint.a_is_world) is_held[joint.a] = 1;
    }
    const auto is_free = [&](std::uint32_t body) { return world.motion[body].inverse_mass == 0 || !is_held[body]; };
    const auto spins = [&](std::uint32_t body) {
        return has_gyroscopic_torque(world.motion[body], world.constants[body], world.settings.time_step);
    };
    for (std::size_t i = 0; i < world.contacts.size(); ++i) {
        ContactGlance& contact = world.contact_glances[i];
        contact.is_idle =
            is_open[i] && is_free(contact.a) && is_free(contact.b) && (spins(contact.a) || spins(contact.b));
        if (contact.is_idle) contact.touches = is_touching(world.contacts[i]);
    }
}

}  // namespace

void find_islands(WorldState& world) {
    // Joints between sleepers stay where they are.
    world.active_joints.clear();
    world.active_joint_slots.clear();
    for (std::uint32_t slot = 0; slot < world.joints.slot_count(); ++slot) {
        if (!world.joints.used(slot)) continue;
        JointRecord& record = world.joints.at(slot);
        if (!is_active(world, record.definition)) continue;
        record.constraint.total_linear = record.constraint.total_angular = {};
        world.active_joints.push_back(record.constraint);
        world.active_joint_slots.push_back(slot);
    }

    set_idle_contacts(world);

    // Kinematic bodies are awake, but no island holds them.
    std::vector<std::uint32_t> movable;
    movable.reserve(world.awake.size());
    for (const std::uint32_t body : world.awake) {
        if (world.motion[body].inverse_mass > 0) movable.push_back(body);
    }
    build_islands(movable, world.motion, world.contact_glances, world.active_joints, world.islands);
    world.report.islands = static_cast<std::uint32_t>(world.islands.list.size());
}

}  // namespace embody::physics
