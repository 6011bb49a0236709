// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "attributes/physical_kind.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// The name that a person would use.
Result<std::string> usual_name(SessionState& state, const Entity& entity) {
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry)) {
        std::string name = physics::shape_name(*shape);
        name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
        return name;
    }
    Result<catalog::ModelSummary> model = state.definitions.models.summary_of(entity);
    if (!model.ok()) return model.error();
    return model.value().name;
}

// A model that a person asks for must be there; only what is in the document already may wait for its model.
Result<void> check_model(SessionState& state, const Entity& entity) {
    const auto* model = std::get_if<ModelReference>(&entity.geometry);
    if (!model) return {};
    const Result<const KnownModel*> found = state.definitions.models.find(model->key);
    if (found.ok()) return {};
    return Error{"entity." + found.error().where, found.error().why, found.error().remedy};
}

// Floors, walls and ceilings that never move: they come locked.
bool is_surroundings(SessionState& state, const Entity& entity) {
    static const std::set<std::string> categories = {"room", "ground",  "floor",     "floor slab",
                                                     "wall", "ceiling", "stud wall", "roof"};
    const Result<attributes::AttributeSet> acting = state.definitions.attributes.acting(entity);
    if (!acting.ok() || !attributes::is_static(kind_of(acting.value()))) return false;
    if (!std::holds_alternative<ModelReference>(entity.geometry)) return categories.contains(entity.category);
    const Result<catalog::ModelSummary> model = state.definitions.models.summary_of(entity);
    return model.ok() &&
           (categories.contains(model.value().category) || categories.contains(model.value().subcategory));
}

// A tap of a scene without a liquid brings water of its own, which starts empty below its mouth.
std::optional<Entity> water_for(SessionState& state, const Entity& entity) {
    if (entity.tap.litres_per_minute == 0 || entity.tap.liquid != 0) return std::nullopt;
    const auto is_liquid = [&state](const Entity& other) { return state.definitions.attributes.is_liquid(other); };
    if (std::ranges::any_of(state.document.entities, is_liquid)) return std::nullopt;
    constexpr Vec3 half{0.25, 0.12, 0.25};  // m, 60 l: with the usual budget drops of 3 ml, 14 mm wide
    Entity water;
    water.name = state.lookup.names.free_name("Water");
    water.geometry = physics::ShapeDefinition(physics::BoxShape{half});
    water.attributes["kind"] = to_value(attributes::PhysicalKind::fluid);
    water.starts_empty = true;
    water.pose.position = transform_point(entity.pose, entity.tap.position) - Vec3{0, half.y, 0};
    return water;
}

Result<json> add(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const json* given = reader.need("entity", "the entity as in a scene file");
    std::optional<Drop> drop;
    read_drop(reader, drop);
    if (!reader.finish()) return *error;
    Result<Entity> read = entity_from_json(*given, "entity");
    if (!read.ok()) return read.error();

    // The new entity gets its own index and name.
    Entity entity = std::move(read).value();
    if (entity.index != 0) return Error{"entity.index", "is given by the session", "leave it out"};
    if (Result<void> room = check_room(state.document, 1); !room.ok()) return room.error();
    if (Result<void> known = check_model(state, entity); !known.ok()) return known.error();
    entity.index = state.document.next_index;
    if (entity.name.empty()) {
        Result<std::string> name = usual_name(state, entity);
        if (!name.ok()) return Error{"entity." + name.error().where, name.error().why, name.error().remedy};
        entity.name = state.lookup.names.free_name(name.value());
    }

    if (!given->contains("locked")) entity.locked = is_surroundings(state, entity);

    // Placed at the pointer.
    if (drop) {
        Result<Placement> placed = place_on_ray(state, entity, drop->ray, {drop->snap, {}});
        if (!placed.ok()) return placed.error();
        entity.pose = placed.value().pose;
        (void)hold_in_place(state, entity, placed.value().seat);
    }
    Edit edit = state.start_edit("Add " + entity.name);
    edit.next_after = entity.index + 1;
    const EntityIndex index = entity.index;
    std::optional<Entity> water = water_for(state, entity);
    edit.changes.emplace_back(EntityChange{std::nullopt, std::move(entity)});
    if (water) {
        water->index = edit.next_after++;
        edit.changes.emplace_back(EntityChange{std::nullopt, std::move(*water)});
    }
    if (Result<void> added = state.commit(std::move(edit)); !added.ok()) return added.error();
    return json{{"index", index}};
}

Result<json> remove(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    need_indices(reader, state, indices);
    if (!reader.finish()) return *error;

    // Joints and pins first: undo goes in the reverse order and needs the entities at their ends.
    Edit edit = state.start_edit("Delete " + state.called(indices));
    const auto goes = [&indices](EntityIndex index) {
        return std::binary_search(indices.begin(), indices.end(), index);
    };
    std::set<std::uint32_t> joints;
    std::set<EntityIndex> pinned;
    for (const EntityIndex index : indices) {
        joints.insert(state.lookup.holds.joints_of(index).begin(), state.lookup.holds.joints_of(index).end());
        pinned.insert(state.lookup.holds.pinned_to(index).begin(), state.lookup.holds.pinned_to(index).end());
    }
    for (const std::uint32_t joint : joints)
        edit.changes.emplace_back(JointChange{*state.document.find_joint(joint), std::nullopt});
    for (const EntityIndex index : pinned) {
        if (goes(index)) continue;
        const Entity& entity = *state.document.find(index);
        Entity unpinned = entity;
        std::erase_if(unpinned.pins, [&goes](const Pin& pin) { return pin.to && goes(*pin.to); });
        edit.changes.emplace_back(change_of(entity, unpinned));
    }
    for (const EntityIndex index : indices)
        edit.changes.emplace_back(EntityChange{*state.document.find(index), std::nullopt});
    return done(state.commit(std::move(edit)));
}

Result<json> transform(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const json* list = reader.need("poses", "a list of {index, position, rotation}");
    Edit edit = state.start_edit({});
    reader.text("merge", edit.merge);
    if (list) read_array(*list, "poses", error);
    std::set<EntityIndex> moved;
    for (std::size_t i = 0; list && !error && i < list->size(); ++i) {
        FieldReader item((*list)[i], element_path("poses", i), error);
        PoseChange change;
        if (!need_index(item, "index", change.index)) break;
        Result<const Entity*> entity = state.entity(change.index, item.path("index"));
        if (!entity.ok()) return entity.error();
        change.before = change.after = entity.value()->pose;
        item.vector("position", change.after.position);
        item.rotation("rotation", change.after.rotation);
        if (!item.finish()) break;
        if (!moved.insert(change.index).second) return Error{item.path("index"), "is there twice"};
        edit.changes.emplace_back(change);
    }
    if (!reader.finish()) return *error;
    edit.label = "Move " + state.called({moved.begin(), moved.end()});
    return done(state.commit(std::move(edit)));
}

Result<json> update(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    need_index(reader, "index", index);
    const json* fields = reader.need("entity", "the fields to change");
    Edit edit = state.start_edit({});
    reader.text("merge", edit.merge);
    if (!reader.finish()) return *error;
    Result<const Entity*> found = state.entity(index, "index");
    if (!found.ok()) return found.error();

    Entity changed = *found.value();
    if (Result<void> read = change_entity_from_json(changed, *fields, "entity", false); !read.ok()) return read.error();
    const bool same_geometry = !fields->contains("model") && !fields->contains("shape");
    if (Result<void> known = same_geometry ? Result<void>{} : check_model(state, changed); !known.ok())
        return known.error();
    edit.label = "Change " + state.called({index});
    if (same_geometry) {
        edit.changes.emplace_back(change_of(*found.value(), changed));
    } else {
        edit.changes.emplace_back(EntityChange{*found.value(), std::move(changed)});
    }
    return done(state.commit(std::move(edit)));
}

Result<json> duplicate(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::optional<Vec3> offset;
    need_indices(reader, state, indices);
    reader.vector("offset", offset);
    if (!reader.finish()) return *error;

    // Placed beside the originals, without overlap.
    if (!offset) {
        Bounds all;
        for (const EntityIndex index : indices) {
            const Bounds bounds = state.simulation->bounds(index);
            if (!bounds.is_empty() && is_finite(bounds.size())) all.add(bounds);
        }
        offset = Vec3{all.is_empty() ? 1 : all.size().x + 0.1, 0, 0};
    }
    Edit edit = state.start_edit("Duplicate " + state.called(indices));
    if (Result<void> room = check_room(state.document, indices.size()); !room.ok()) return room.error();
    NamesInUse& names = state.lookup.names;
    json copies = json::array();
    std::map<EntityIndex, EntityIndex> copy_of;
    for (const EntityIndex index : indices) copy_of.emplace(index, edit.next_after++);
    for (const EntityIndex index : indices) {
        Entity copy = *state.document.find(index);
        copy.index = copy_of.at(index);
        copy.locked = false;
        // Pins between copied things lead to the copies, as between the originals.
        for (Pin& pin : copy.pins)
            if (pin.to && copy_of.contains(*pin.to)) pin.to = copy_of.at(*pin.to);
        if (copy_of.contains(copy.tap.liquid)) copy.tap.liquid = copy_of.at(copy.tap.liquid);
        if (!copy.name.empty()) copy.name = names.free_name(copy.name);
        names.add(copy.name);
        copy.pose.position += *offset;
        copies.push_back(copy.index);
        edit.changes.emplace_back(EntityChange{std::nullopt, std::move(copy)});
    }
    // The commit assigns their final names.
    for (const Change& change : edit.changes) names.remove(std::get<EntityChange>(change).after->name);
    if (Result<void> added = state.commit(std::move(edit)); !added.ok()) return added.error();
    return json{{"indices", std::move(copies)}};
}

Result<json> lock(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    bool locked = true;
    need_indices(reader, state, indices);
    if (reader.need("locked", "true or false")) reader.truth("locked", locked);
    if (!reader.finish()) return *error;
    Edit edit = state.start_edit((locked ? "Lock " : "Unlock ") + state.called(indices));
    for (const EntityIndex index : indices) {
        const Entity& before = *state.document.find(index);
        if (before.locked == locked) continue;
        EntityChange change = change_of(before, before);
        change.after->locked = locked;
        edit.changes.emplace_back(std::move(change));
    }
    return done(state.commit(std::move(edit)));
}

}  // namespace

Result<void> check_room(const Document& document, std::size_t count) {
    if (document.next_index > last_document_index - count + 1)
        return Error{
            "entity", "no index is left",
            "give the entity with the highest index a lower one in the scene file, and take next_index out of it"};
    if (document.entities.size() + count <= max_entities) return {};
    return Error{"entity", "a scene can have " + std::to_string(max_entities) + " entities", "delete some first"};
}

std::span<const Command> entity_commands() {
    static constexpr Command commands[] = {
        {"entity.add", add},       {"entity.remove", remove},       {"entity.transform", transform},
        {"entity.update", update}, {"entity.duplicate", duplicate}, {"entity.lock", lock}};
    return commands;
}

}  // namespace embody::scene
