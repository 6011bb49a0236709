// SPDX-License-Identifier: MIT
// Entities whose models are not in the catalogue: they wait outside of the world until the models come.
#include <algorithm>
#include <iterator>
#include <utility>

#include "scene/document/document_field.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

/// A message names at most so many missing models.
constexpr std::size_t max_named_models = 20;

const ModelReference* model_of(const Entity& entity) { return std::get_if<ModelReference>(&entity.geometry); }

}  // namespace

bool Simulation::State::must_wait(const Entity& entity) {
    const ModelReference* model = model_of(entity);
    return may_wait && model && !definitions.models.find(model->key).ok();
}

Result<void> Simulation::State::check_models(const Document& document) {
    std::optional<Error> first;
    std::set<std::string> missing;
    for (const Entity& entity : document.entities) {
        const ModelReference* model = model_of(entity);
        if (!model) continue;
        const bool is_known_missing = missing.contains(model->key);
        const auto found = is_known_missing ? Result<const KnownModel*>(nullptr) : definitions.models.find(model->key);
        if (!is_known_missing && found.ok()) continue;
        if (may_wait) waiting.emplace(entity.index, entity);
        if (!first) first = of_entity(entity, found.error());
        missing.insert(model->key);
    }
    if (!first || may_wait) return {};
    if (missing.size() == 1) return *first;
    first->why += "; missing are " + std::to_string(missing.size()) + " models:";
    std::size_t named = 0;
    for (const std::string& key : missing) {
        if (named++ == max_named_models) {
            first->why += ", …";
            break;
        }
        first->why += (named > 1 ? ", " : " ") + key;
    }
    first->remedy = "import them, or take other keys";
    return *first;
}

Result<void> Simulation::State::add_whole(const Entity& entity) {
    if (Result<void> added = add(entity); !added.ok()) return added;
    Result<void> held = fasten_all(entity.index);
    if (!held.ok()) remove_all({entity.index});
    return held;
}

Result<void> Simulation::State::add_or_wait(const Entity& entity) {
    if (!must_wait(entity)) return add_whole(entity);
    if (live.contains(entity.index) || !waiting.emplace(entity.index, entity).second)
        return of_entity(entity, {"index", "is in the world already"});
    return {};
}

Result<void> Simulation::State::update_or_wait(const Entity& entity, bool keep_motion) {
    const bool waits = must_wait(entity);
    if (const auto before = waiting.find(entity.index); before != waiting.end()) {
        if (!waits) return arrive(Entity(before->second), entity);
        before->second = entity;
        return {};
    }
    if (!waits || !live.contains(entity.index)) return update(entity, keep_motion);
    leave(entity);
    return {};
}

// The entity leaves the world, and its joints wait with it.
void Simulation::State::leave(const Entity& entity) {
    for (const std::uint32_t joint : holds.joints_of(entity.index))
        waiting_joints.insert_or_assign(joint, joints.at(joint).definition);
    remove_all({entity.index});
    waiting.emplace(entity.index, entity);
}

// What waited as `before` comes into the world with its joints, or goes on waiting.
Result<void> Simulation::State::arrive(const Entity& before, const Entity& entity) {
    waiting.erase(entity.index);
    if (Result<void> added = add_whole(entity); !added.ok()) {
        waiting.emplace(entity.index, before);
        return added;
    }
    const std::vector<Error> refused = add_joints_that_waited();
    if (refused.empty()) return {};
    leave(before);
    return refused.front();
}

std::vector<Error> Simulation::State::add_joints_that_waited() {
    std::vector<Error> refused;
    for (auto next = waiting_joints.begin(); next != waiting_joints.end();) {
        const SceneJoint joint = next->second;
        if (is_waiting_end(joint)) {
            ++next;
            continue;
        }
        next = waiting_joints.erase(next);
        // An action may have removed what is at its other end.
        const bool has_ends = live.contains(joint.entity_b) && (!joint.entity_a || live.contains(*joint.entity_a));
        const Result<void> added = has_ends ? add_joint(joint) : Result<void>{};
        if (!added.ok()) refused.push_back(added.error());
    }
    return refused;
}

bool Simulation::State::is_waiting_end(const SceneJoint& joint) const {
    return waiting.contains(joint.entity_b) || (joint.entity_a && waiting.contains(*joint.entity_a));
}

Arrivals Simulation::State::take_arrivals() {
    Arrivals arrivals;
    std::set<std::string> missing;
    std::vector<Entity> came;
    for (const auto& [index, entity] : waiting) {
        const std::string& key = model_of(entity)->key;
        if (missing.contains(key)) continue;
        if (must_wait(entity))
            missing.insert(key);
        else
            came.push_back(entity);
    }
    // What is still to come counts as waiting: pins between two of them are fastened with the second one.
    for (const Entity& entity : came) {
        waiting.erase(entity.index);
        if (Result<void> added = add_whole(entity); added.ok())
            arrivals.came.push_back(entity.index);
        else
            arrivals.refused.push_back(added.error());
    }
    std::ranges::move(add_joints_that_waited(), std::back_inserter(arrivals.refused));
    return arrivals;
}

}  // namespace embody::scene
