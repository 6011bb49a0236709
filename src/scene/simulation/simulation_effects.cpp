// SPDX-License-Identifier: MIT
// Effects of actions on entities, and their queries.
#include <algorithm>

#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

// Maximum number of spawned entities, pieces of broken things too: an action that spawns at every contact would fill
// the memory.
constexpr std::size_t max_spawned = 10'000;
// Maximum number per step: an action that answers contacts by things that make contacts must not explode within a step.
constexpr std::size_t max_spawned_per_step = 32;

}  // namespace

Result<void> Simulation::State::set_attribute(LiveEntity& entity, const SetAttribute& set) {
    Entity changed = entity.definition;
    changed.attributes[set.name] = set.value;
    return update(changed, true);
}

Result<void> Simulation::State::change(EntityIndex index, const Effect& effect) {
    LiveEntity* found = find(index);
    if (!found) return Error{"receiver", "entity " + std::to_string(index) + " is not in the world"};
    LiveEntity& entity = *found;
    if (const auto* set = std::get_if<SetAttribute>(&effect)) return set_attribute(entity, *set);
    if (const auto* impulse = std::get_if<ApplyImpulse>(&effect))
        return entity.points ? entity.points->apply_impulse(impulse->impulse)
                             : world->apply_impulse(entity.body, impulse->impulse, impulse->at);
    if (const auto* push = std::get_if<ApplyForce>(&effect)) {
        timed_forces.push_back({index, push->force, world->last_report().time + push->duration});
        return {};
    }
    if (const auto* velocity = std::get_if<SetVelocity>(&effect))
        return set_velocity(entity, velocity->linear, velocity->angular);
    if (const auto* enable = std::get_if<SetEnabled>(&effect)) {
        entity.definition.enabled = enable->enabled;
        return entity.points ? entity.points->set_enabled(enable->enabled)
                             : world->set_enabled(entity.body, enable->enabled);
    }
    if (const auto* set = std::get_if<SetOpen>(&effect)) {
        entity.definition.tap.open = entity.definition.drain.open = set->open;
        return {};
    }
    if (const auto* melting = std::get_if<Melt>(&effect)) return melt(entity, *melting);
    if (std::holds_alternative<Freeze>(effect)) return freeze(entity);
    remove_all({index});
    despawned.push_back(index);
    return {};
}

Result<EntityIndex> Simulation::State::new_index() const {
    if (next_spawned - last_document_index <= max_spawned) return next_spawned;
    return Error{"spawn", "10000 entities were spawned in this run",
                 "let the action fire less often, or things break into fewer pieces"};
}

Result<EntityIndex> Simulation::State::spawn(EntityIndex like, const Spawn& spawn) {
    if (const auto index = new_index(); !index.ok()) return index.error();
    if (spawned_by_actions >= max_spawned_per_step) return Error{"spawn", "32 entities were spawned in this step"};
    const Entity* original = definition(like);
    if (const auto found = templates.find(like); found != templates.end()) original = &found->second;
    if (!original) return Error{"receiver", "entity " + std::to_string(like) + " is not there any more"};
    Entity copy = *original;
    copy.index = next_spawned;
    copy.pose = spawn.pose;
    copy.linear_velocity = spawn.linear_velocity;
    copy.angular_velocity = {};
    copy.enabled = true;
    copy.start_asleep = false;
    if (const Result<void> added = add(copy); !added.ok()) return added.error();
    spawned.push_back(next_spawned);
    ++spawned_by_actions;
    return next_spawned++;
}

// A primitive's own category, or the taxonomy's of a model.
std::string Simulation::State::category(EntityIndex index) const {
    const LiveEntity* entity = find(index);
    if (!entity) return {};
    return entity->definition.category.empty() ? entity->attributes->word("category", "") : entity->definition.category;
}

Vec3 Simulation::State::center_of_mass(const LiveEntity& entity) const {
    return entity.points ? entity.points->center_of_mass() : world->center_of_mass(entity.body);
}

std::vector<EntityIndex> Simulation::State::meant(const Target& target) const {
    std::vector<EntityIndex> found;
    for (const auto& [index, entity] : templates) {
        const bool is_meant =
            target.by == Target::By::any || (target.by == Target::By::index && target.index == index) ||
            (target.by == Target::By::name && target.word == entity.name) ||
            (target.by == Target::By::category && (entity.category == target.word || category(index) == target.word));
        if (is_meant) found.push_back(index);
    }
    return found;
}

void Simulation::State::start_actions(const std::vector<Action>& list) {
    ActionRunner::World face;
    face.entities = [this]() -> const std::vector<EntityIndex>& { return indices; };
    face.definition = [this](EntityIndex index) { return definition(index); };
    face.category = [this](EntityIndex index) { return category(index); };
    face.center_of_mass = [this](EntityIndex index) { return center_of_mass(live.at(index)); };
    face.change = [this](EntityIndex index, const Effect& effect) { return change(index, effect); };
    face.spawn = [this](EntityIndex like, const Spawn& what) { return spawn(like, what); };
    face.templates = [this](const Target& target) { return meant(target); };
    actions = std::make_unique<ActionRunner>(list, std::move(face));
}

// A push lasts at least one step.
void Simulation::State::apply_timed_forces() {
    const double time = world->last_report().time;
    for (const TimedForce& push : timed_forces) {
        const LiveEntity* entity = find(push.entity);
        if (!entity) continue;
        const Result<void> pushed =
            entity->points ? entity->points->apply_force(push.force) : world->apply_force(entity->body, push.force);
        if (!pushed.ok()) actions->problems.push_back(pushed.error());
    }
    const double next = time + world->settings().time_step;
    std::erase_if(timed_forces, [next](const TimedForce& push) { return push.until <= next * (1 + 1e-12); });
}

const Entity* Simulation::State::definition(EntityIndex index) const {
    const LiveEntity* entity = find(index);
    return entity ? &entity->definition : nullptr;
}

}  // namespace embody::scene
