// SPDX-License-Identifier: MIT
#include "scene/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "attributes/surfaces.h"
#include "attributes/to_physics.h"
#include "scene/document/document_field.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

using attributes::AttributeSet;
using physics::BodyHandle;
using physics::JointHandle;

namespace {

// Contacts between grains of one entity are left out, and those of hands, which are no entity.
std::vector<physics::ContactEvent> contacts_between_entities(const physics::World& world) {
    std::vector<physics::ContactEvent> contacts;
    for (const physics::ContactEvent& event : world.contact_events())
        if (event.user_data_a != event.user_data_b && event.user_data_a != 0 && event.user_data_b != 0)
            contacts.push_back(event);
    return contacts;
}

// Liquids of unlike densities share one grid, whose cells are those of the first: the one with the coarsest cells, as
// finer ones could be more than the budget of the others allows.
void sort_layers(EntityAttributes& acting, std::vector<const Entity*>& liquids) {
    struct Cells {
        const Entity* entity;
        double size, density;
    };
    std::vector<Cells> cells;
    for (const Entity* entity : liquids) {
        const Result<AttributeSet> set = acting.acting(*entity);
        const physics::FluidDefinition fluid =
            set.ok() ? attributes::fluid_from_attributes(set.value()) : physics::FluidDefinition{};
        cells.push_back({entity, fluid.cell_size, fluid.density});
    }
    const auto is_alike = [&](const Cells& other) { return other.density == cells.front().density; };
    if (std::ranges::all_of(cells, is_alike)) return;
    std::ranges::stable_sort(cells, std::greater{}, &Cells::size);
    std::ranges::transform(cells, liquids.begin(), &Cells::entity);
}

Error not_in_world(EntityIndex entity) {
    return {"index", "entity " + std::to_string(entity) + " is not in the world"};
}

}  // namespace

Simulation::Simulation() = default;
Simulation::~Simulation() = default;

Result<std::unique_ptr<Simulation>> Simulation::create(const Document& document, catalog::Catalog* catalog,
                                                       std::shared_ptr<FormCache> forms, MissingModels missing) {
    Result<std::unique_ptr<physics::World>> world = physics::World::create(document.settings);
    if (!world.ok())
        return Error{"settings." + document_field(world.error().where), world.error().why, world.error().remedy};
    std::unique_ptr<Simulation> simulation(new Simulation);
    if (!forms) forms = std::make_shared<FormCache>();
    forms->begin();
    simulation->state_ =
        std::make_unique<State>(std::move(world).value(), document.settings, catalog, std::move(forms));
    State& state = *simulation->state_;
    state.may_wait = missing == MissingModels::wait && catalog != nullptr;
    if (catalog != nullptr) {
        Result<void> set = state.world->set_surface_pairs(catalog->taxonomy().surfaces().table());
        if (!set.ok()) return set.error();
    }

    if (Result<void> known = state.check_models(document); !known.ok()) return known.error();

    // Entities that joints and pins need as one body are made as one from the start.
    state.find_bodies(document);

    // Entities are made in the document's order, so that the same document makes the same world; liquids last, since
    // they fill the space that the others leave free.
    std::vector<const Entity*> liquids;
    for (const Entity& entity : document.entities) {
        state.templates[entity.index] = entity;
        if (state.waiting.contains(entity.index)) continue;
        if (state.definitions.attributes.is_liquid(entity)) {
            liquids.push_back(&entity);
        } else if (Result<void> added = state.add(entity); !added.ok()) {
            return added.error();
        }
    }
    sort_layers(state.definitions.attributes, liquids);
    for (const Entity* liquid : liquids)
        if (Result<void> added = state.add(*liquid); !added.ok()) return added.error();
    if (Result<void> held = state.fasten_all({}); !held.ok()) return held.error();
    for (const SceneJoint& joint : document.joints)
        if (Result<void> added = state.add_joint(joint); !added.ok()) return added.error();
    state.to_be_held.clear();
    state.start_actions(document.actions);
    return simulation;
}

const physics::StepReport& Simulation::step() {
    State& state = *state_;
    state.spawned.clear();
    state.spawned_by_actions = 0;
    state.despawned.clear();
    state.broke.clear();
    state.melted.clear();
    state.actions->fired.clear();
    state.actions->problems.clear();
    state.actions->pause_requested = false;

    // Actions that are due, physics, then actions that the physics triggered.
    state.actions->before_step(state.world->last_report().time);
    state.apply_timed_forces();
    state.liquids.push(state.world->settings().time_step);
    state.set_ports();
    const physics::StepReport& report = state.world->step();
    state.count_ports();
    state.take_pieces();
    state.liquids.separate_distant();
    const auto sleeps = state.world->sleep_events();
    state.actions->after_step(contacts_between_entities(*state.world), {sleeps.begin(), sleeps.end()});
    return report;
}

bool Simulation::pause_requested() const { return state_->actions->pause_requested; }
const std::vector<ActionFired>& Simulation::fired() const { return state_->actions->fired; }
const std::vector<Error>& Simulation::problems() const { return state_->actions->problems; }
std::span<const physics::SheetTearEvent> Simulation::sheet_tears() const { return state_->world->sheet_tear_events(); }
std::span<const physics::RopeBreakEvent> Simulation::rope_breaks() const { return state_->world->rope_break_events(); }
const std::vector<ThingBroke>& Simulation::broke() const { return state_->broke; }
const std::vector<ThingMelted>& Simulation::melted() const { return state_->melted; }
const std::vector<EntityIndex>& Simulation::spawned() const { return state_->spawned; }
const std::vector<EntityIndex>& Simulation::despawned() const { return state_->despawned; }

Result<void> Simulation::run_action(std::uint32_t action, EntityIndex sender) {
    return state_->actions->request(action, sender);
}

std::size_t Simulation::signal(const std::string& key, const std::string& button) {
    return state_->actions->signal(key, button);
}

physics::World& Simulation::world() { return *state_->world; }
const physics::World& Simulation::world() const { return *state_->world; }
const std::vector<EntityIndex>& Simulation::entities() const { return state_->indices; }

Result<void> Simulation::set_settings(const physics::WorldSettings& settings) {
    const physics::WorldSettings before = std::exchange(state_->settings, settings);
    Result<void> set = state_->world->set_settings(settings);
    if (set.ok()) return state_->apply_settings();
    state_->settings = before;
    return Error{document_field(set.error().where), set.error().why, set.error().remedy};
}

bool Simulation::contains(EntityIndex entity) const { return state_->live.contains(entity); }

BodyHandle Simulation::body(EntityIndex entity) const {
    const LiveEntity* found = state_->find(entity);
    return found ? found->body : BodyHandle{};
}

const MovingPoints* Simulation::points(EntityIndex entity) const {
    const LiveEntity* found = state_->find(entity);
    return found ? found->points.get() : nullptr;
}

Transform Simulation::pose(EntityIndex entity) const {
    const LiveEntity* found = state_->find(entity);
    return found ? state_->pose_of(*found) : Transform{};
}

Bounds Simulation::bounds(EntityIndex entity) const {
    const MovingPoints* its = points(entity);
    return its ? its->bounds() : state_->world->bounds(body(entity));
}

std::optional<double> Simulation::drop_distance(EntityIndex entity, double max_distance) const {
    const MovingPoints* its = points(entity);
    if (its) return its->drop_distance(max_distance);
    return state_->world->drop_distance(body(entity), max_distance,
                                        [this](BodyHandle other) { return state_->hand(other) != nullptr; });
}

std::optional<Simulation::RayHit> Simulation::cast_ray(Vec3 origin, Vec3 direction, double max_distance,
                                                       EntityIndex ignore) const {
    std::optional<RayHit> nearest;
    if (const auto hit = state_->cast_ray(origin, direction, max_distance, body(ignore)))
        nearest = RayHit{entity(hit->body), hit->position, hit->normal, hit->distance};
    for (const auto& [index, live] : state_->live) {
        if (!live.points || index == ignore) continue;
        const auto hit = live.points->cast_ray(origin, direction, nearest ? nearest->distance : max_distance);
        if (hit) nearest = RayHit{index, origin + hit->distance * direction, hit->normal, hit->distance};
    }
    return nearest;
}

bool Simulation::is_movable(EntityIndex entity) const {
    return points(entity) != nullptr || std::isfinite(state_->world->mass(body(entity)));
}

physics::SleepState Simulation::sleep_state(EntityIndex entity) const {
    const MovingPoints* its = points(entity);
    return its ? its->state() : state_->world->sleep_state(body(entity));
}

Activity Simulation::activity() const {
    Activity activity;
    std::vector<Vec3> positions;
    for (const auto& [index, entity] : state_->live) {
        if (!entity.definition.enabled || !is_movable(index)) continue;
        ++activity.things;
        const physics::SleepState state = sleep_state(index);
        ++(state == physics::SleepState::asleep           ? activity.asleep
           : state == physics::SleepState::wants_to_sleep ? activity.wants_to_sleep
                                                          : activity.active);
        if (!entity.points) continue;
        entity.points->read(positions);
        activity.points += positions.size();
    }
    return activity;
}

Result<void> Simulation::set_pose(EntityIndex entity, const Transform& pose) {
    LiveEntity* found = state_->find(entity);
    return found ? state_->place(*found, pose) : not_in_world(entity);
}

Result<void> Simulation::set_velocity(EntityIndex entity, Vec3 linear, Vec3 angular) {
    LiveEntity* found = state_->find(entity);
    return found ? state_->set_velocity(*found, linear, angular) : not_in_world(entity);
}

EntityIndex Simulation::entity(BodyHandle body) const {
    const std::optional<physics::BodyDefinition> definition = state_->world->body(body);
    return definition ? static_cast<EntityIndex>(definition->user_data) : 0;
}

const Entity* Simulation::definition(EntityIndex entity) const { return state_->definition(entity); }

JointHandle Simulation::joint(std::uint32_t joint) const {
    const auto found = state_->joints.find(joint);
    return found == state_->joints.end() ? JointHandle{} : found->second.joint;
}

Result<AttributeSet> Simulation::attributes(EntityIndex entity) const {
    const LiveEntity* found = state_->find(entity);
    if (!found) return not_in_world(entity);
    return *found->attributes;
}

Result<void> Simulation::add(const Entity& entity) {
    if (Result<void> added = state_->add_or_wait(entity); !added.ok()) return added;
    state_->templates[entity.index] = entity;
    return {};
}

Result<void> Simulation::update(const Entity& entity, bool keep_motion) {
    if (Result<void> updated = state_->update_or_wait(entity, keep_motion); !updated.ok()) return updated;
    state_->templates[entity.index] = entity;
    return {};
}

Result<void> Simulation::renew_models(const std::set<std::string>& keys, bool keep_motion) {
    std::vector<Entity> meant;
    for (const auto& [index, entity] : state_->live) {
        const auto* model = std::get_if<ModelReference>(&entity.definition.geometry);
        if (model && keys.contains(model->key)) meant.push_back(entity.definition);
    }
    for (const std::string& key : keys) state_->definitions.forget(key);
    state_->shapes.release(state_->solid_key, std::exchange(state_->solid, {}));
    Result<void> all;
    for (const Entity& entity : meant) {
        Result<void> updated = state_->update(entity, keep_motion);
        if (!updated.ok() && all.ok()) all = std::move(updated);
    }
    return all;
}

Result<void> Simulation::remove(EntityIndex entity) {
    if (!contains(entity) && !is_waiting(entity)) return not_in_world(entity);
    remove_all({entity});
    return {};
}

void Simulation::remove_all(const std::vector<EntityIndex>& entities) {
    std::vector<EntityIndex> there;
    for (const EntityIndex entity : entities) {
        state_->templates.erase(entity);
        state_->waiting.erase(entity);
        if (state_->live.contains(entity)) there.push_back(entity);
    }
    state_->remove_all(there);
}

Result<void> Simulation::add_joint(const SceneJoint& joint) { return state_->add_joint(joint); }

Result<void> Simulation::remove_joint(std::uint32_t joint) {
    if (state_->waiting_joints.erase(joint) > 0) return {};
    return state_->remove_joint(joint);
}

bool Simulation::contains_joint(std::uint32_t joint) const {
    return state_->joints.contains(joint) || state_->waiting_joints.contains(joint);
}

bool Simulation::is_waiting(EntityIndex entity) const { return state_->waiting.contains(entity); }

std::vector<EntityIndex> Simulation::waiting() const {
    std::vector<EntityIndex> indices;
    for (const auto& [index, entity] : state_->waiting) indices.push_back(index);
    return indices;
}

Arrivals Simulation::take_arrivals() { return state_->take_arrivals(); }

void Simulation::set_actions(const std::vector<Action>& actions) { state_->actions->set_actions(actions); }

}  // namespace embody::scene
