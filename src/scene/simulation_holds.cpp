// SPDX-License-Identifier: MIT
// What holds entities together: joints, and the pins of what changes its form.
#include <algorithm>

#include "scene/simulation_state.h"

namespace embody::scene {

using physics::BodyHandle;
using physics::JointHandle;

bool Simulation::State::is_held_as_body(EntityIndex index) const {
    if (to_be_held.contains(index)) return true;
    const auto joins = [index](const auto& item) {
        const SceneJoint& joint = item.second.definition;
        return joint.entity_b == index || joint.entity_a == index;
    };
    const auto is_pinned_to_it = [index](const auto& item) {
        const std::vector<Pin>& pins = item.second.definition.pins;
        return std::ranges::any_of(pins, [index](const Pin& pin) { return pin.to == index; });
    };
    return std::ranges::any_of(joints, joins) || std::ranges::any_of(live, is_pinned_to_it);
}

Result<void> Simulation::State::fasten(const LiveEntity& entity) {
    const physics::DeformableDefinition* deformable = entity.points ? entity.points->deformable() : nullptr;
    if (!deformable) return {};
    std::vector<physics::Attachment> attachments;
    std::vector<bool> is_held(deformable->nodes.size(), false);
    for (const std::uint32_t node : deformable->pinned) is_held[node] = true;
    std::vector<Vec3> positions;
    entity.points->read(positions);
    for (std::size_t i = 0; i < entity.definition.pins.size(); ++i) {
        const Pin& pin = entity.definition.pins[i];
        if (!pin.to) continue;
        const LiveEntity* other = find(*pin.to);
        const std::string where = "pins[" + std::to_string(i) + "].to";
        if (!other) return of_entity(entity.definition, {where, "entity " + std::to_string(*pin.to) + " is not there"});
        if (other->points)
            return of_entity(entity.definition, {where, "is no single body", "pin it to a rigid or static thing"});
        const Transform pose = world->pose(other->body);
        for (const std::uint32_t node : pinned_nodes(pin, deformable->nodes)) {
            if (is_held[node]) continue;
            is_held[node] = true;
            attachments.push_back({node, other->body, inverse_transform_point(pose, positions[node])});
        }
    }
    return entity.points->attach(std::move(attachments));
}

Result<void> Simulation::State::fasten_all(std::optional<EntityIndex> came) {
    for (const auto& [index, entity] : live) {
        const bool is_meant = !came || index == *came ||
                              std::ranges::any_of(entity.definition.pins, [&](const Pin& p) { return p.to == came; });
        if (!is_meant) continue;
        if (Result<void> held = fasten(entity); !held.ok()) return held;
    }
    return {};
}

// Soft ends of a joint are rigid as long as it is there.
Result<void> Simulation::State::make_bodies_of(const SceneJoint& joint) {
    for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
        const LiveEntity* end = find(index);
        if (!end || !end->points) continue;
        to_be_held.insert(index);
        Result<void> made = update(Entity(end->definition), true);
        to_be_held.erase(index);
        if (!made.ok()) return made;
    }
    return {};
}

// What a joint held may be soft again.
Result<void> Simulation::State::soften_ends(const SceneJoint& joint) {
    for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
        const LiveEntity* end = find(index);
        if (!end || end->form.note.empty() || is_held_as_body(index)) continue;
        if (Result<void> made = update(Entity(end->definition), true); !made.ok()) return made;
    }
    return {};
}

Result<BodyHandle> Simulation::State::end_of(EntityIndex index, const std::string& where) {
    const LiveEntity* end = find(index);
    if (!end) return Error{where, "is not in the world"};
    if (end->points) return Error{where, "is no single body", "joints need a rigid thing"};
    return end->body;
}

Result<void> Simulation::State::add_joint(const SceneJoint& joint) {
    const std::string who = "joint " + std::to_string(joint.index);
    if (joints.contains(joint.index)) return Error{who, "is in the world already"};
    if (Result<void> made = make_bodies_of(joint); !made.ok()) return made;
    physics::JointDefinition definition = joint.definition;
    const Result<BodyHandle> b = end_of(joint.entity_b, who + ": entity_b");
    const Result<BodyHandle> a =
        joint.entity_a ? end_of(*joint.entity_a, who + ": entity_a") : Result<BodyHandle>(BodyHandle{});
    if (!b.ok()) return b.error();
    if (!a.ok()) return a.error();
    definition.body_b = b.value();
    definition.body_a = a.value();
    const Result<JointHandle> handle = world->create_joint(definition);
    if (!handle.ok()) return Error{who + ": " + handle.error().where, handle.error().why, handle.error().remedy};
    joints.emplace(joint.index, LiveJoint{joint, handle.value()});
    return {};
}

Result<void> Simulation::State::remove_joint(std::uint32_t index) {
    const auto found = joints.find(index);
    if (found == joints.end()) return Error{"index", "joint " + std::to_string(index) + " is not in the world"};
    Result<void> removed = world->destroy_joint(found->second.joint);
    const SceneJoint definition = found->second.definition;
    joints.erase(found);
    return removed.ok() ? soften_ends(definition) : removed;
}

}  // namespace embody::scene
