// SPDX-License-Identifier: MIT
#include "physics/optimization/islands.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

#include <numeric>

namespace embody::physics::stages {

namespace {

bool is_active(const IslandAccess& world, const JointDefinition& joint) {
    const auto moves = [&](std::uint32_t body) {
        return world.rigid.record(body).definition.enabled && world.rigid.is_dynamic(body) &&
               !world.activity.is_asleep(body);
    };
    const auto is_there = [&](std::uint32_t body) { return world.rigid.record(body).definition.enabled; };
    if (!is_there(joint.body_b.index)) return false;
    if (joint.body_a.is_null()) return moves(joint.body_b.index);
    return is_there(joint.body_a.index) && (moves(joint.body_a.index) || moves(joint.body_b.index));
}

// Contacts that need no solver: by the paths of the impact stage the surfaces stay apart. A spinning body then moves
// freely, exactly, without the contact solver's approximate turns, if nothing else holds either body; and joints
// without contacts keep their energy, while joints solved alternately with contacts do not.
void set_idle_contacts(const IslandAccess& world) {
    const ImpactMemory& memory = world.impacts;
    std::vector<std::uint8_t>& is_held = world.impacts.is_held;
    is_held.assign(world.rigid.motion.size(), 0);
    for (std::size_t i = 0; i < world.contacts.list.size(); ++i) {
        const ContactSummary& contact = world.contacts.summaries[i];
        if (!memory.is_open[i]) is_held[contact.a] = is_held[contact.b] = 1;
    }
    for (const Joint& joint : world.joints.active) {
        is_held[joint.b] = 1;
        if (!joint.a_is_world) is_held[joint.a] = 1;
    }
    const auto is_free = [&](std::uint32_t body) {
        return world.rigid.motion[body].inverse_mass == 0 || !is_held[body];
    };
    const auto spins = [&](std::uint32_t body) {
        return has_gyroscopic_torque(world.rigid.motion[body], world.rigid.constants[body], world.settings.time_step);
    };
    const auto has_path = [&](std::uint32_t body) {
        return !memory.has_jointed_path.empty() && memory.has_jointed_path[body];
    };
    for (std::size_t i = 0; i < world.contacts.list.size(); ++i) {
        ContactSummary& contact = world.contacts.summaries[i];
        const bool a_has_path = has_path(contact.a), b_has_path = has_path(contact.b);
        contact.is_idle = memory.is_open[i] && (a_has_path || is_free(contact.a)) &&
                          (b_has_path || is_free(contact.b)) &&
                          (a_has_path || b_has_path || spins(contact.a) || spins(contact.b));
        if (contact.is_idle) contact.touches = is_touching(world.contacts.list[i]);
    }
}

// Union-find with path halving.
std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t body) {
    while (parents[body] != body) body = parents[body] = parents[parents[body]];
    return body;
}

// The bodies that active joints hold, without those connected with a joint that has a limit or a motor: that may stop
// them within a step, so that their paths are not known.
void mark_jointed_paths(const IslandAccess& world) {
    std::vector<std::uint8_t>& has_path = world.impacts.has_jointed_path;
    has_path.clear();
    if (world.joints.active.empty()) return;
    has_path.resize(world.rigid.motion.size());
    std::vector<std::uint32_t>& parents = world.impacts.assembly_parent;
    parents.resize(world.rigid.motion.size());
    std::iota(parents.begin(), parents.end(), 0U);
    const auto moves = [&](std::uint32_t body) { return world.rigid.motion[body].inverse_mass > 0; };
    for (const Joint& joint : world.joints.active) {
        if (moves(joint.b)) has_path[joint.b] = 1;
        if (joint.a_is_world || !moves(joint.a)) continue;
        has_path[joint.a] = 1;
        if (moves(joint.b)) parents[root_of(parents, joint.a)] = root_of(parents, joint.b);
    }
    for (const Joint& joint : world.joints.active) {
        if (!has_motor(joint) && !has_limit(joint)) continue;
        if (moves(joint.b)) has_path[root_of(parents, joint.b)] = 0;
        if (!joint.a_is_world && moves(joint.a)) has_path[root_of(parents, joint.a)] = 0;
    }
    for (std::uint32_t body = 0; body < has_path.size(); ++body) {
        has_path[body] = has_path[body] && has_path[root_of(parents, body)] ? 1 : 0;
    }
}

}  // namespace

void list_active_joints(const IslandAccess& world) {
    // Joints between sleepers belong to no island.
    world.joints.active.clear();
    world.joints.active_slots.clear();
    for (std::uint32_t slot = 0; slot < world.joints.records.slot_count(); ++slot) {
        if (!world.joints.records.used(slot)) continue;
        JointRecord& record = world.joints.records.at(slot);
        if (!is_active(world, record.definition)) continue;
        record.constraint.total_linear = record.constraint.total_angular = {};
        world.joints.active.push_back(record.constraint);
        world.joints.active_slots.push_back(slot);
    }
    mark_jointed_paths(world);
}

void find_islands(const IslandAccess& world) {
    set_idle_contacts(world);

    // Kinematic bodies are awake, but no island holds them.
    std::vector<std::uint32_t>& movable = world.activity.movable;
    movable.clear();
    for (const std::uint32_t body : world.activity.awake) {
        if (world.rigid.motion[body].inverse_mass > 0) movable.push_back(body);
    }
    build_islands(movable, world.rigid.motion, world.contacts.summaries, world.joints.active, world.islands);
    world.report.islands = static_cast<std::uint32_t>(world.islands.list.size());
}

}  // namespace embody::physics::stages
