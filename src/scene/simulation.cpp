// SPDX-License-Identifier: MIT
#include "scene/simulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "attributes/surfaces.h"
#include "physics/inter/definitions/grain_material.h"
#include "scene/action_runner.h"
#include "scene/entity_body.h"
#include "scene/grain_bodies.h"
#include "scene/soft_nodes.h"

namespace embody::scene {

using attributes::AttributeSet;
using physics::BodyHandle;
using physics::JointHandle;
using physics::ShapeHandle;

namespace {

// Beyond this an action that spawns whenever something touches would fill the memory.
constexpr std::size_t most_spawned = 10'000;
// An action that answers contacts with things that make contacts must not explode within a step.
constexpr std::size_t most_spawned_a_step = 32;

Error of_entity(const Entity& entity, Error error) {
    std::string who = "entity " + std::to_string(entity.index);
    if (!entity.name.empty()) who += " (" + entity.name + ")";
    error.where = error.where.empty() ? who : who + ": " + error.where;
    return error;
}

struct LiveEntity {
    Entity definition;
    AttributeSet attributes;
    BodyHandle body;  // null of what has points
    ShapeHandle shape;
    std::string shape_key;
    std::unique_ptr<GrainBodies> grains;  // of a granular one
    std::unique_ptr<SoftNodes> soft;      // of a soft one
    bool is_soft = false;                 // its kind says so, and tetrahedra could be made
    std::string filling;                  // what points were made of: the same, the same places
    Transform frame;                      // of grains: where they were put, or moved to by hand
    std::string note;                     // why it is not what its kind says; empty: it is

    [[nodiscard]] MovingPoints* points() const {
        return grains ? static_cast<MovingPoints*>(grains.get()) : soft.get();
    }
};

bool is_granular(const AttributeSet& attributes) { return attributes.word("kind", "") == "granular"; }

// Equal where the form of a soft thing is.
std::string form_of(const Entity& entity, const AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    return key.empty() ? key : key + '\n' + std::to_string(entity.scale);
}

// Equal where geometry and size of the grains are.
std::string filling_of(const Entity& entity, const AttributeSet& attributes) {
    const std::string key = EntityBodies::shape_key(entity, attributes);
    if (key.empty()) return {};
    return key + '\n' + std::to_string(attributes.number("simulated_diameter", 0)) + '\n' +
           std::to_string(attributes.number("grain_budget", 0));
}

struct SharedShape {
    ShapeHandle shape;
    int users = 0;
};

struct LiveJoint {
    SceneJoint definition;
    JointHandle joint;
};

// A push that an action gave, until a moment.
struct TimedForce {
    EntityIndex entity = 0;
    Vec3 force;
    double until = 0;
};

// Grains of one entity that meet are no news.
std::vector<physics::ContactEvent> contacts_between_entities(const physics::World& world) {
    std::vector<physics::ContactEvent> contacts;
    for (const physics::ContactEvent& event : world.contact_events())
        if (event.user_data_a != event.user_data_b) contacts.push_back(event);
    return contacts;
}

}  // namespace

struct Simulation::State {
    std::unique_ptr<physics::World> world;
    physics::WorldSettings settings;  // the document's
    double finest_grain = 1e300;      // that was ever in this world, m
    EntityBodies bodies;
    std::map<EntityIndex, Entity> templates;  // the document's entities, for actions that spawn
    std::map<EntityIndex, LiveEntity> live;
    std::vector<EntityIndex> indices;
    std::map<std::string, SharedShape> shared_shapes;
    std::map<std::uint32_t, LiveJoint> joints;
    std::set<EntityIndex> to_be_held;  // entities that joints or pins need as one body, before these are there
    std::vector<TimedForce> timed_forces;
    std::vector<EntityIndex> spawned, despawned;
    EntityIndex next_spawned = last_document_index + 1;
    std::unique_ptr<ActionRunner> actions;

    explicit State(catalog::Catalog* catalog) : bodies(catalog) {}

    // Shapes -----------------------------------------------------------------------------------------------------

    Result<void> take_shape(LiveEntity& entity) {
        const auto shared = shared_shapes.find(entity.shape_key);
        if (!entity.shape_key.empty() && shared != shared_shapes.end()) {
            ++shared->second.users;
            entity.shape = shared->second.shape;
            return {};
        }
        Result<physics::ShapeDefinition> definition = bodies.shape(entity.definition, entity.attributes);
        if (!definition.ok()) return definition.error();
        const Result<ShapeHandle> shape = world->create_shape(definition.value());
        if (!shape.ok()) return Error{"shape: " + shape.error().where, shape.error().why, shape.error().remedy};
        entity.shape = shape.value();
        if (!entity.shape_key.empty()) shared_shapes[entity.shape_key] = {entity.shape, 1};
        return {};
    }

    // Only after the body that used it is gone or has another.
    void give_shape_back(const LiveEntity& entity) {
        if (entity.shape.is_null()) return;
        const auto shared = shared_shapes.find(entity.shape_key);
        if (!entity.shape_key.empty() && shared != shared_shapes.end()) {
            if (--shared->second.users > 0) return;
            shared_shapes.erase(shared);
        }
        // Nobody else has it, so the world does not refuse.
        const Result<void> destroyed = world->destroy_shape(entity.shape);
        (void)destroyed;
    }

    // Entities -----------------------------------------------------------------------------------------------------

    // What it is made of, without anything of it in the world.
    Result<LiveEntity> describe(const Entity& entity) {
        LiveEntity described;
        described.definition = entity;
        Result<AttributeSet> set = bodies.attributes(entity);
        if (!set.ok()) return set.error();
        described.attributes = std::move(set).value();
        described.frame = entity.pose;
        find_form(described);
        if (is_granular(described.attributes))
            described.filling = filling_of(entity, described.attributes);
        else if (described.is_soft)
            described.filling = form_of(entity, described.attributes);
        else
            described.shape_key = EntityBodies::shape_key(entity, described.attributes);
        return described;
    }

    // Whether a joint holds it or something is pinned to it.
    [[nodiscard]] bool is_held_as_body(EntityIndex index) const {
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

    // What cannot be soft is rigid, with a note why.
    void find_form(LiveEntity& entity) {
        if (entity.attributes.word("kind", "") != "soft") return;
        if (is_held_as_body(entity.definition.index)) {
            entity.note = "is simulated as rigid, because a joint or a pin holds on to it";
            return;
        }
        const Result<const catalog::SoftMesh*> mesh = bodies.soft_mesh(entity.definition);
        entity.is_soft = mesh.ok();
        if (!mesh.ok()) entity.note = "is simulated as rigid, because " + mesh.error().why;
    }

    // With its shape; the body's definition lacks nothing then.
    Result<physics::BodyDefinition> prepare_body(LiveEntity& entity) {
        Result<physics::BodyDefinition> made = bodies.body(entity.definition, entity.attributes);
        if (!made.ok()) return made.error();
        if (const Result<void> taken = take_shape(entity); !taken.ok()) return taken.error();
        made.value().shape = entity.shape;
        return made;
    }

    Result<void> put_body(LiveEntity& entity) {
        const Result<physics::BodyDefinition> body = prepare_body(entity);
        if (!body.ok()) return body.error();
        const Result<BodyHandle> handle = world->create_body(body.value());
        if (!handle.ok()) {
            give_shape_back(entity);
            return handle.error();
        }
        entity.body = handle.value();
        return {};
    }

    Result<void> put_grains(LiveEntity& entity) {
        const Result<GrainDefinition> definition = bodies.grains(entity.definition, entity.attributes);
        if (!definition.ok()) return definition.error();
        Result<std::unique_ptr<GrainBodies>> grains = GrainBodies::create(*world, definition.value());
        if (!grains.ok()) return grains.error();
        entity.grains = std::move(grains).value();
        finest_grain = std::min(finest_grain, definition.value().diameter);
        return apply_settings();
    }

    Result<void> put(LiveEntity& entity) {
        if (is_granular(entity.attributes)) return put_grains(entity);
        return entity.is_soft ? put_soft(entity) : put_body(entity);
    }

    Result<void> put_soft(LiveEntity& entity) {
        const Result<physics::DeformableDefinition> definition = bodies.soft(entity.definition, entity.attributes);
        if (!definition.ok()) return definition.error();
        Result<std::unique_ptr<SoftNodes>> soft = SoftNodes::create(*world, definition.value());
        if (!soft.ok()) return soft.error();
        entity.soft = std::move(soft).value();
        return {};
    }

    // Holds what its pins say to where that is now on other entities.
    Result<void> fasten(const LiveEntity& entity) {
        if (!entity.soft) return {};
        std::vector<physics::Attachment> attachments;
        std::vector<bool> is_held(entity.soft->deformable()->nodes.size(), false);
        for (const std::uint32_t node : entity.soft->deformable()->pinned) is_held[node] = true;
        std::vector<Vec3> positions;
        entity.soft->read(positions);
        for (std::size_t i = 0; i < entity.definition.pins.size(); ++i) {
            const Pin& pin = entity.definition.pins[i];
            if (!pin.to) continue;
            const auto other = live.find(*pin.to);
            const std::string where = "pins[" + std::to_string(i) + "].to";
            if (other == live.end())
                return of_entity(entity.definition, {where, "entity " + std::to_string(*pin.to) + " is not there"});
            if (other->second.points())
                return of_entity(entity.definition, {where, "is no single body", "pin it to a rigid or static thing"});
            for (const std::uint32_t node : pinned_nodes(pin, entity.soft->deformable()->nodes)) {
                if (is_held[node]) continue;
                is_held[node] = true;
                const Transform pose = world->pose(other->second.body);
                attachments.push_back({node, other->second.body, inverse_transform_point(pose, positions[node])});
            }
        }
        return entity.soft->attach(std::move(attachments));
    }

    // An entity that came, and those whose pins waited for it; without one: all.
    Result<void> fasten_all(std::optional<EntityIndex> came) {
        for (const auto& [index, entity] : live) {
            const bool is_meant =
                !came || index == *came ||
                std::ranges::any_of(entity.definition.pins, [&](const Pin& p) { return p.to == came; });
            if (!is_meant) continue;
            if (Result<void> held = fasten(entity); !held.ok()) return held;
        }
        return {};
    }

    void take_out(LiveEntity& entity) {
        entity.grains.reset();
        entity.soft.reset();
        if (entity.body.is_null()) return;
        // It is in the world, which does not refuse.
        (void)world->destroy_body(entity.body).ok();
        give_shape_back(entity);
    }

    // Heaps of small grains need finer steps than the document asks for.
    Result<void> apply_settings() {
        physics::WorldSettings finer = settings;
        if (finest_grain < 1e300) finer.substeps = physics::substeps_for_grains(finest_grain, settings);
        return finer.substeps == world->settings().substeps ? Result<void>{} : world->set_settings(finer);
    }

    Result<void> add(const Entity& entity) {
        if (live.contains(entity.index)) return of_entity(entity, {"index", "is in the world already"});
        Result<LiveEntity> described = describe(entity);
        if (!described.ok()) return of_entity(entity, described.error());
        if (const Result<void> placed = put(described.value()); !placed.ok()) return of_entity(entity, placed.error());
        live.emplace(entity.index, std::move(described).value());
        indices.insert(std::lower_bound(indices.begin(), indices.end(), entity.index), entity.index);
        return {};
    }

    [[nodiscard]] Transform pose_of(const LiveEntity& entity) const {
        return entity.points() ? entity.points()->pose().value_or(entity.frame) : world->pose(entity.body);
    }

    // Of its centre of mass, and its spin; grains have none in common.
    [[nodiscard]] std::pair<Vec3, Vec3> motion_of(const LiveEntity& entity) const {
        if (entity.soft) return {entity.soft->linear_velocity(), entity.soft->angular_velocity()};
        if (entity.points()) return {};
        return {world->linear_velocity(entity.body), world->angular_velocity(entity.body)};
    }

    // The same body takes the new definition.
    Result<void> update_body(LiveEntity& before, LiveEntity& after, bool keep_motion) {
        Result<physics::BodyDefinition> body = prepare_body(after);
        if (!body.ok()) return body.error();
        after.body = before.body;
        if (keep_motion) {
            const Transform pose = world->pose(before.body);
            body.value().position = pose.position;
            body.value().rotation = pose.rotation;
            body.value().linear_velocity = world->linear_velocity(before.body);
            body.value().angular_velocity = world->angular_velocity(before.body);
            body.value().start_asleep = false;
        }
        if (const Result<void> changed = world->set_body(before.body, body.value()); !changed.ok()) {
            give_shape_back(after);
            return changed.error();
        }
        give_shape_back(before);
        return {};
    }

    // The same grains go on with other friction, mass and the like.
    Result<void> update_grains(LiveEntity& before, LiveEntity& after) {
        const Result<GrainDefinition> definition = bodies.grains(after.definition, after.attributes);
        if (!definition.ok()) return definition.error();
        if (Result<void> set = before.grains->set_body(definition.value().body); !set.ok()) return set;
        after.grains = std::move(before.grains);
        after.frame = before.frame;
        return {};
    }

    // The same nodes go on with other matter; what its pins hold to others stays held where it is.
    Result<void> update_soft(LiveEntity& before, LiveEntity& after) {
        Result<physics::DeformableDefinition> definition = bodies.soft(after.definition, after.attributes);
        if (!definition.ok()) return definition.error();
        if (before.definition.pins == after.definition.pins)
            definition.value().attachments = before.soft->attachments();
        if (Result<void> set = before.soft->set_definition(definition.value()); !set.ok()) return set;
        after.soft = std::move(before.soft);
        return before.definition.pins == after.definition.pins ? Result<void>{} : fasten(after);
    }

    // Another kind, or other grains: made anew where it is.
    Result<void> replace(LiveEntity& before, LiveEntity& after, bool keep_motion) {
        if (is_granular(after.attributes) && is_held_as_body(before.definition.index))
            return Error{"attributes.kind", "grains cannot be held by a joint", "remove the joint first"};
        const Entity document = after.definition;
        if (keep_motion) {
            after.definition.pose = after.frame = pose_of(before);
            if (!before.grains)
                std::tie(after.definition.linear_velocity, after.definition.angular_velocity) = motion_of(before);
        }
        Result<void> placed = put(after);
        if (placed.ok()) placed = fasten(after);
        after.definition = document;
        if (!placed.ok()) {
            take_out(after);
            return placed;
        }
        take_out(before);
        return {};
    }

    Result<void> update(const Entity& entity, bool keep_motion) {
        const auto found = live.find(entity.index);
        if (found == live.end()) return of_entity(entity, {"index", "is not in the world"});
        LiveEntity& before = found->second;
        Result<LiveEntity> described = describe(entity);
        if (!described.ok()) return of_entity(entity, described.error());
        LiveEntity& after = described.value();
        const bool same_grains =
            before.grains && !after.filling.empty() && after.filling == before.filling && keep_motion;
        const bool same_soft =
            before.soft && after.is_soft && !after.filling.empty() && after.filling == before.filling && keep_motion;
        const bool both_bodies = !before.points() && !after.is_soft && !is_granular(after.attributes);
        const Result<void> updated = both_bodies   ? update_body(before, after, keep_motion)
                                     : same_grains ? update_grains(before, after)
                                     : same_soft   ? update_soft(before, after)
                                                   : replace(before, after, keep_motion);
        if (!updated.ok()) return of_entity(entity, updated.error());
        before = std::move(after);
        return {};
    }

    Result<void> remove(EntityIndex entity) {
        const auto found = live.find(entity);
        if (found == live.end()) return Error{"index", "entity " + std::to_string(entity) + " is not in the world"};
        std::erase_if(joints, [entity](const auto& item) {
            const SceneJoint& joint = item.second.definition;
            return joint.entity_b == entity || joint.entity_a == entity;
        });
        take_out(found->second);
        live.erase(found);
        indices.erase(std::lower_bound(indices.begin(), indices.end(), entity));
        std::erase_if(timed_forces, [entity](const TimedForce& push) { return push.entity == entity; });
        return {};
    }

    Result<void> place(LiveEntity& entity, const Transform& pose) {
        if (!entity.points()) return world->set_pose(entity.body, pose);
        if (Result<void> moved = entity.points()->move(pose * inverse(pose_of(entity))); !moved.ok()) return moved;
        entity.frame = pose;
        return {};
    }

    Result<void> set_velocity(LiveEntity& entity, Vec3 linear, Vec3 angular) {
        return entity.points() ? entity.points()->set_velocity(linear, angular)
                               : world->set_velocity(entity.body, linear, angular);
    }

    // Soft ends of a joint are rigid as long as it is there.
    Result<void> make_bodies_of(const SceneJoint& joint) {
        for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
            const auto found = live.find(index);
            if (found == live.end() || !found->second.soft) continue;
            to_be_held.insert(index);
            Result<void> made = update(found->second.definition, true);
            to_be_held.erase(index);
            if (!made.ok()) return made;
        }
        return {};
    }

    // What a joint held may be soft again.
    Result<void> soften_ends(const SceneJoint& joint) {
        for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
            const auto found = live.find(index);
            if (found == live.end() || found->second.note.empty() || is_held_as_body(index)) continue;
            if (Result<void> made = update(found->second.definition, true); !made.ok()) return made;
        }
        return {};
    }

    Result<void> add_joint(const SceneJoint& joint) {
        const std::string who = "joint " + std::to_string(joint.index);
        if (joints.contains(joint.index)) return Error{who, "is in the world already"};
        physics::JointDefinition definition = joint.definition;
        if (Result<void> made = make_bodies_of(joint); !made.ok()) return made;
        const auto b = live.find(joint.entity_b);
        if (b == live.end()) return Error{who + ": entity_b", "is not in the world"};
        if (b->second.points()) return Error{who + ": entity_b", "is no single body", "joints need a rigid thing"};
        definition.body_b = b->second.body;
        definition.body_a = {};
        if (joint.entity_a) {
            const auto a = live.find(*joint.entity_a);
            if (a == live.end()) return Error{who + ": entity_a", "is not in the world"};
            if (a->second.points()) return Error{who + ": entity_a", "is no single body", "joints need a rigid thing"};
            definition.body_a = a->second.body;
        }
        const Result<JointHandle> handle = world->create_joint(definition);
        if (!handle.ok()) return Error{who + ": " + handle.error().where, handle.error().why, handle.error().remedy};
        joints.emplace(joint.index, LiveJoint{joint, handle.value()});
        return {};
    }

    // Effects of actions ---------------------------------------------------------------------------------------------

    Result<void> set_attribute(LiveEntity& entity, const SetAttribute& set) {
        Entity changed = entity.definition;
        changed.attributes[set.name] = set.value;
        return update(changed, true);
    }

    Result<void> push(const LiveEntity& entity, const ApplyForce& push) {
        timed_forces.push_back({entity.definition.index, push.force, world->last_report().time + push.duration});
        return {};
    }

    Result<void> change(EntityIndex index, const Effect& effect) {
        const auto found = live.find(index);
        if (found == live.end()) return Error{"receiver", "entity " + std::to_string(index) + " is not in the world"};
        LiveEntity& entity = found->second;
        if (const auto* set = std::get_if<SetAttribute>(&effect)) return set_attribute(entity, *set);
        if (const auto* impulse = std::get_if<ApplyImpulse>(&effect))
            return entity.points() ? entity.points()->apply_impulse(impulse->impulse)
                                   : world->apply_impulse(entity.body, impulse->impulse, impulse->at);
        if (const auto* force = std::get_if<ApplyForce>(&effect)) return push(entity, *force);
        if (const auto* velocity = std::get_if<SetVelocity>(&effect))
            return set_velocity(entity, velocity->linear, velocity->angular);
        if (const auto* enable = std::get_if<SetEnabled>(&effect)) {
            entity.definition.enabled = enable->enabled;
            return entity.points() ? entity.points()->set_enabled(enable->enabled)
                                   : world->set_enabled(entity.body, enable->enabled);
        }
        Result<void> removed = remove(index);
        if (removed.ok()) despawned.push_back(index);
        return removed;
    }

    Result<EntityIndex> spawn(EntityIndex like, const Spawn& spawn) {
        if (next_spawned - last_document_index > most_spawned)
            return Error{"spawn", "10000 entities were spawned in this run", "let the action fire less often"};
        if (spawned.size() >= most_spawned_a_step) return Error{"spawn", "32 entities were spawned in this step"};
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
        return next_spawned++;
    }

    // Questions of actions -------------------------------------------------------------------------------------------

    [[nodiscard]] const Entity* definition(EntityIndex index) const {
        const auto found = live.find(index);
        return found == live.end() ? nullptr : &found->second.definition;
    }

    // A primitive's own category, or what the taxonomy says of a model.
    [[nodiscard]] std::string category(EntityIndex index) const {
        const auto found = live.find(index);
        if (found == live.end()) return {};
        const LiveEntity& entity = found->second;
        return entity.definition.category.empty() ? entity.attributes.word("category", "") : entity.definition.category;
    }

    [[nodiscard]] Vec3 center_of_mass(const LiveEntity& entity) const {
        return entity.points() ? entity.points()->center_of_mass() : world->center_of_mass(entity.body);
    }

    [[nodiscard]] std::vector<EntityIndex> meant(const Target& target) const {
        std::vector<EntityIndex> found;
        for (const auto& [index, entity] : templates) {
            const bool is_meant = target.by == Target::By::any ||
                                  (target.by == Target::By::index && target.index == index) ||
                                  (target.by == Target::By::name && target.word == entity.name) ||
                                  (target.by == Target::By::category &&
                                   (entity.category == target.word || category(index) == target.word));
            if (is_meant) found.push_back(index);
        }
        return found;
    }

    void start_actions(const std::vector<Action>& list) {
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
    void apply_timed_forces() {
        const double time = world->last_report().time;
        for (const TimedForce& push : timed_forces) {
            const auto found = live.find(push.entity);
            if (found == live.end()) continue;
            const LiveEntity& entity = found->second;
            const Result<void> pushed = entity.points() ? entity.points()->apply_force(push.force)
                                                        : world->apply_force(entity.body, push.force);
            if (!pushed.ok()) actions->problems.push_back(pushed.error());
        }
        const double next = time + world->settings().time_step;
        std::erase_if(timed_forces, [next](const TimedForce& push) { return push.until <= next * (1 + 1e-12); });
    }
};

Simulation::Simulation() = default;
Simulation::~Simulation() = default;

Result<std::unique_ptr<Simulation>> Simulation::create(const Document& document, catalog::Catalog* catalog) {
    std::unique_ptr<Simulation> simulation(new Simulation);
    simulation->state_ = std::make_unique<State>(catalog);
    State& state = *simulation->state_;
    Result<std::unique_ptr<physics::World>> world = physics::World::create(document.settings);
    if (!world.ok()) return Error{"settings." + world.error().where, world.error().why, world.error().remedy};
    state.world = std::move(world).value();
    state.settings = document.settings;
    if (catalog != nullptr) {
        Result<void> set = state.world->set_surface_pairs(catalog->taxonomy().surfaces().table());
        if (!set.ok()) return set.error();
    }

    // What joints and pins need as one body is made as one at once.
    for (const SceneJoint& joint : document.joints)
        state.to_be_held.insert({joint.entity_b, joint.entity_a.value_or(0)});
    for (const Entity& entity : document.entities)
        for (const Pin& pin : entity.pins) state.to_be_held.insert(pin.to.value_or(0));

    // In the document's order, so that the same document is the same world.
    for (const Entity& entity : document.entities) {
        state.templates[entity.index] = entity;
        if (Result<void> added = state.add(entity); !added.ok()) return added.error();
    }
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
    state.despawned.clear();
    state.actions->fired.clear();
    state.actions->problems.clear();
    state.actions->pause_requested = false;

    // Due actions, physics, what the physics set off.
    state.actions->before_step(state.world->last_report().time);
    state.apply_timed_forces();
    const physics::StepReport& report = state.world->step();
    const auto sleeps = state.world->sleep_events();
    state.actions->after_step(contacts_between_entities(*state.world), {sleeps.begin(), sleeps.end()});
    return report;
}

bool Simulation::pause_requested() const { return state_->actions->pause_requested; }
const std::vector<ActionFired>& Simulation::fired() const { return state_->actions->fired; }
const std::vector<Error>& Simulation::problems() const { return state_->actions->problems; }
const std::vector<EntityIndex>& Simulation::spawned() const { return state_->spawned; }
const std::vector<EntityIndex>& Simulation::despawned() const { return state_->despawned; }

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
    return set;
}

bool Simulation::contains(EntityIndex entity) const { return state_->live.contains(entity); }

BodyHandle Simulation::body(EntityIndex entity) const {
    const auto found = state_->live.find(entity);
    return found == state_->live.end() ? BodyHandle{} : found->second.body;
}

BodyHandle Simulation::hold(EntityIndex entity, Vec3 position) {
    let_go();
    const auto found = state_->live.find(entity);
    if (found == state_->live.end()) return {};
    return found->second.points() ? found->second.points()->hold(position) : found->second.body;
}

void Simulation::let_go() {
    for (auto& [index, entity] : state_->live)
        if (entity.points()) entity.points()->let_go();
}

std::vector<std::string> Simulation::notes() const {
    std::vector<std::string> notes;
    for (const auto& [index, entity] : state_->live) {
        if (entity.note.empty()) continue;
        const std::string& name = entity.definition.name;
        notes.push_back((name.empty() ? "Entity " + std::to_string(index) : name) + " " + entity.note + ".");
    }
    return notes;
}

const MovingPoints* Simulation::points(EntityIndex entity) const {
    const auto found = state_->live.find(entity);
    return found == state_->live.end() ? nullptr : found->second.points();
}

Transform Simulation::pose(EntityIndex entity) const {
    const auto found = state_->live.find(entity);
    return found == state_->live.end() ? Transform{} : state_->pose_of(found->second);
}

Bounds Simulation::bounds(EntityIndex entity) const {
    const MovingPoints* its = points(entity);
    return its ? its->bounds() : state_->world->bounds(body(entity));
}

std::optional<double> Simulation::drop_distance(EntityIndex entity, double most) const {
    const MovingPoints* its = points(entity);
    return its ? its->drop_distance(most) : state_->world->drop_distance(body(entity), most);
}

std::optional<Simulation::RayHit> Simulation::cast_ray(Vec3 origin, Vec3 direction, double most,
                                                       EntityIndex ignore) const {
    std::optional<RayHit> nearest;
    if (const auto hit = state_->world->cast_ray(origin, direction, most, body(ignore)))
        nearest = RayHit{entity(hit->body), hit->position, hit->normal, hit->distance};
    for (const auto& [index, live] : state_->live) {
        if (!live.points() || index == ignore) continue;
        const auto hit = live.points()->cast_ray(origin, direction, nearest ? nearest->distance : most);
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

Result<void> Simulation::set_pose(EntityIndex entity, const Transform& pose) {
    const auto found = state_->live.find(entity);
    if (found == state_->live.end()) return Error{"index", "entity " + std::to_string(entity) + " is not in the world"};
    return state_->place(found->second, pose);
}

Result<void> Simulation::set_velocity(EntityIndex entity, Vec3 linear, Vec3 angular) {
    const auto found = state_->live.find(entity);
    if (found == state_->live.end()) return Error{"index", "entity " + std::to_string(entity) + " is not in the world"};
    return state_->set_velocity(found->second, linear, angular);
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
    const auto found = state_->live.find(entity);
    if (found == state_->live.end()) return Error{"index", "entity " + std::to_string(entity) + " is not in the world"};
    return found->second.attributes;
}

Result<void> Simulation::add(const Entity& entity) {
    if (Result<void> added = state_->add(entity); !added.ok()) return added;
    if (Result<void> held = state_->fasten_all(entity.index); !held.ok()) {
        (void)state_->remove(entity.index).ok();
        return held;
    }
    state_->templates[entity.index] = entity;
    return {};
}

Result<void> Simulation::update(const Entity& entity, bool keep_motion) {
    if (Result<void> updated = state_->update(entity, keep_motion); !updated.ok()) return updated;
    state_->templates[entity.index] = entity;
    return {};
}

Result<void> Simulation::renew_models(const std::set<std::string>& keys, bool keep_motion) {
    std::vector<Entity> meant;
    for (const auto& [index, entity] : state_->live) {
        const auto* model = std::get_if<ModelReference>(&entity.definition.geometry);
        if (model && keys.contains(model->key)) meant.push_back(entity.definition);
    }
    for (const std::string& key : keys) state_->bodies.forget(key);
    Result<void> all;
    for (const Entity& entity : meant) {
        Result<void> updated = state_->update(entity, keep_motion);
        if (!updated.ok() && all.ok()) all = std::move(updated);
    }
    return all;
}

Result<void> Simulation::remove(EntityIndex entity) {
    state_->templates.erase(entity);
    return state_->remove(entity);
}

Result<void> Simulation::add_joint(const SceneJoint& joint) { return state_->add_joint(joint); }

Result<void> Simulation::remove_joint(std::uint32_t joint) {
    const auto found = state_->joints.find(joint);
    if (found == state_->joints.end()) return Error{"index", "joint " + std::to_string(joint) + " is not in the world"};
    Result<void> removed = state_->world->destroy_joint(found->second.joint);
    const SceneJoint definition = found->second.definition;
    state_->joints.erase(found);
    return removed.ok() ? state_->soften_ends(definition) : removed;
}

void Simulation::set_actions(const std::vector<Action>& actions) { state_->actions->set_actions(actions); }

}  // namespace embody::scene
