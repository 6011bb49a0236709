// SPDX-License-Identifier: MIT
#include "scene/session/scene_part.h"

#include <algorithm>
#include <map>

#include "scene/session/commands/commands.h"
#include "scene/session/groups.h"

namespace embody::scene {

namespace {

// The targets of an action: sender, receiver, and the other one of a contact.
template <class Visit>
void for_each_target(auto& action, Visit&& visit) {
    visit(action.sender);
    visit(action.receiver);
    std::visit(
        [&visit](auto& trigger) {
            if constexpr (requires { trigger.other; }) visit(trigger.other);
        },
        action.trigger);
}

bool names_entity(const Target& target) { return target.by == Target::By::index; }

// Actions that name nobody of the part belong to the scene.
bool belongs_to(const Action& action, const std::vector<EntityIndex>& indices) {
    bool names_some = false, names_others = false;
    for_each_target(action, [&](const Target& target) {
        if (!names_entity(target)) return;
        (std::binary_search(indices.begin(), indices.end(), target.index) ? names_some : names_others) = true;
    });
    return names_some && !names_others;
}

}  // namespace

Document part_of(const Document& document, const std::vector<EntityIndex>& indices) {
    Document part;
    static_cast<Heading&>(part) = document;
    const auto is_in = [&](EntityIndex index) { return std::binary_search(indices.begin(), indices.end(), index); };
    for (const EntityIndex index : indices) {
        part.entities.push_back(*document.find(index));
        std::erase_if(part.entities.back().pins, [&](const Pin& pin) { return pin.to && !is_in(*pin.to); });
        EntityIndex& liquid = part.entities.back().tap.liquid;
        if (!is_in(liquid)) liquid = 0;
        part.next_index = index + 1;
    }
    for (const SceneJoint& joint : document.joints)
        if (is_in(joint.entity_b) && (!joint.entity_a || is_in(*joint.entity_a))) part.joints.push_back(joint);
    for (const Action& action : document.actions)
        if (belongs_to(action, indices)) part.actions.push_back(action);
    return part;
}

PartAdder::PartAdder(SessionState& state, Edit& edit) : state_(state), edit_(edit) {
    if (!state.document.joints.empty()) next_joint_ = state.document.joints.back().index + 1;
    if (!state.document.actions.empty()) next_action_ = state.document.actions.back().id + 1;
}

// The commit assigns the names for good.
PartAdder::~PartAdder() {
    for (const std::string& name : names_) state_.lookup.names.remove(name);
}

Result<std::vector<EntityIndex>> PartAdder::add(const Document& part, const Transform& motion) {
    const std::size_t added = static_cast<std::size_t>(edit_.next_after - edit_.next_before);
    if (Result<void> room = check_room(state_.document, added + part.entities.size()); !room.ok()) return room.error();
    if (next_joint_ + part.joints.size() > last_document_index ||
        next_action_ + part.actions.size() > last_document_index)
        return Error{"part", "no number is left for its joints or actions"};
    std::map<EntityIndex, EntityIndex> copy_of;
    std::map<std::string, std::string> groups;
    for (const Entity& entity : part.entities) copy_of.emplace(entity.index, edit_.next_after++);
    std::vector<EntityIndex> indices;
    for (const Entity& entity : part.entities) {
        Entity copy = entity;
        copy.index = copy_of.at(entity.index);
        for (Pin& pin : copy.pins) {
            if (pin.to) pin.to = copy_of.at(*pin.to);
        }
        const auto liquid = copy_of.find(copy.tap.liquid);
        copy.tap.liquid = liquid == copy_of.end() ? 0 : liquid->second;
        if (!copy.name.empty()) copy.name = state_.lookup.names.free_name(copy.name);
        state_.lookup.names.add(copy.name);
        names_.push_back(copy.name);
        // Copies of a group are a group of their own.
        const std::string outermost = outermost_group(copy.group);
        if (!outermost.empty()) {
            auto known = groups.find(outermost);
            if (known == groups.end())
                known = groups.emplace(outermost, free_group(state_.document, "", outermost, groups_)).first;
            groups_.insert(known->second);
            copy.group = moved_group(copy.group, outermost, known->second);
        }
        copy.pose = motion * copy.pose;
        indices.push_back(copy.index);
        edit_.changes.emplace_back(EntityChange{std::nullopt, std::move(copy)});
    }
    for (SceneJoint joint : part.joints) {
        joint.index = next_joint_++;
        joint.entity_b = copy_of.at(joint.entity_b);
        if (joint.entity_a)
            joint.entity_a = copy_of.at(*joint.entity_a);
        else
            joint.definition.frame_a = motion * joint.definition.frame_a;
        edit_.changes.emplace_back(JointChange{std::nullopt, std::move(joint)});
    }
    for (Action action : part.actions) {
        action.id = next_action_++;
        for_each_target(action, [&copy_of](Target& target) {
            if (names_entity(target) && copy_of.contains(target.index)) target.index = copy_of.at(target.index);
        });
        edit_.changes.emplace_back(ActionChange{std::nullopt, std::move(action)});
    }
    return indices;
}

}  // namespace embody::scene
