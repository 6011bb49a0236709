// SPDX-License-Identifier: MIT
#include "scene/document/document_index.h"

#include <algorithm>
#include <charconv>

namespace embody::scene {

namespace {

constexpr int first_number = 2;

void remove(DocumentIndex& index, const Entity& entity) {
    index.names.remove(entity.name);
    index.holds.remove_pins(entity.index, entity.pins);
}

void add(DocumentIndex& index, const Entity& entity) {
    index.names.add(entity.name);
    index.holds.add_pins(entity.index, entity.pins);
}

bool is_wall(const Entity& entity) {
    const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry);
    return shape && std::holds_alternative<physics::WallShape>(*shape);
}

}  // namespace

void NamesInUse::remove(const std::string& name) {
    const auto found = count_.find(name);
    if (--found->second > 0) return;
    count_.erase(found);
    // Without "Box 7" that name is free for the next "Box".
    const std::size_t space = name.rfind(' ');
    int number = 0;
    const char* const end = name.data() + name.size();
    if (space == std::string::npos || std::from_chars(name.data() + space + 1, end, number).ptr != end) return;
    const auto next = next_number_.find(name.substr(0, space));
    if (next != next_number_.end() && number >= first_number) next->second = std::min(next->second, number);
}

void NamesInUse::clear() {
    count_.clear();
    next_number_.clear();
}

std::string NamesInUse::free_name(const std::string& wanted) {
    if (!count_.contains(wanted)) return wanted;
    int& number = next_number_.try_emplace(wanted, first_number).first->second;
    for (;; ++number) {
        std::string name = wanted + " " + std::to_string(number);
        if (!count_.contains(name)) return name;
    }
}

void DocumentIndex::assign(const Document& document) {
    names.clear();
    holds = {};
    walls.clear();
    for (const Entity& entity : document.entities) {
        add(*this, entity);
        if (is_wall(entity)) walls.insert(entity.index);
    }
    for (const SceneJoint& joint : document.joints) holds.add_joint(joint);
}

void DocumentIndex::apply(const std::vector<Change>& changes) {
    for (const Change& change : changes) {
        if (const auto* entity = std::get_if<EntityChange>(&change)) {
            if (entity->before) remove(*this, *entity->before);
            if (entity->after) add(*this, *entity->after);
            if (entity->same_geometry) continue;
            if (entity->before) walls.erase(entity->before->index);
            if (entity->after && is_wall(*entity->after)) walls.insert(entity->after->index);
        } else if (const auto* joint = std::get_if<JointChange>(&change)) {
            if (joint->before) holds.remove_joint(*joint->before);
            if (joint->after) holds.add_joint(*joint->after);
        }
    }
}

}  // namespace embody::scene
