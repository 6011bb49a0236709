// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/resolver.h"
#include "scene/embody/entity_body.h"
#include "scene/file/json/parts.h"
#include "scene/matter/soft_nodes.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using attributes::AttributeDescription;
using attributes::AttributeEntry;
using attributes::AttributeSet;
using nlohmann::json;

json attribute_rows(const AttributeSet& acting, const AttributeSet& automatic, const std::vector<std::string>& own,
                    const std::vector<attributes::Issue>& issues) {
    constexpr std::array type_names{"number", "word", "truth", "vector", "tensor"};
    json rows = json::array();
    for (const AttributeEntry& entry : acting.entries()) {
        json row = attributes::to_json(entry);
        for (const char* field : {"low", "high"})
            if (!row.contains(field)) row[field] = nullptr;

        // Data that the panel needs to edit the value, and to reset it.
        const AttributeDescription* description = attributes::describe(entry.name);
        if (description) {
            row["kind_label"] = description->kind_label;
            row["type"] = type_names[static_cast<std::size_t>(description->type)];
            row["choices"] = description->choices;
            row["range"] = nullptr;
            const auto end = [](const std::optional<double>& value) {
                return value ? attributes::to_json(*value) : json(nullptr);
            };
            if (description->low || description->high) row["range"] = {end(description->low), end(description->high)};
        }
        const AttributeEntry* before = automatic.find(entry.name);
        row["automatic"] = before ? attributes::to_json(before->value) : json(nullptr);
        row["overridden"] = std::find(own.begin(), own.end(), entry.name) != own.end();
        row["warnings"] = json::array();
        for (const attributes::Issue& issue : issues)
            if (issue.attribute == entry.name) row["warnings"].push_back(warning_json(issue));
        rows.push_back(std::move(row));
    }
    return rows;
}

namespace {

// The value with its null components replaced by those of `present`: they stay as they are.
json with_present(const json& value, const json& present) {
    if (value.is_null()) return present;
    if (!value.is_array() || !present.is_array() || value.size() != present.size()) return value;
    json filled = json::array();
    for (std::size_t i = 0; i < value.size(); ++i) filled.push_back(with_present(value[i], present[i]));
    return filled;
}

bool has_null(const json& value) {
    return value.is_array() &&
           std::any_of(value.begin(), value.end(), [](const json& item) { return item.is_null() || has_null(item); });
}

/// A new value of each entity; empty: the automatic one.
using NewValues = std::vector<std::optional<attributes::AttributeValue>>;

Result<attributes::AttributeValue> read_value(const SessionState& state, const std::string& name, const json& value) {
    Result<attributes::AttributeValue> read = attribute_from_json(name, value, "value");
    if (read.ok() && state.catalog)
        read = attributes::known_value(state.catalog->taxonomy(), name, std::move(read).value());
    return read;
}

// Of a vector or tensor with null components each entity keeps its own there.
Result<NewValues> read_values(SessionState& state, const std::vector<EntityIndex>& indices, const std::string& name,
                              const json& value) {
    NewValues values;
    if (!has_null(value)) {
        Result<attributes::AttributeValue> read = read_value(state, name, value);
        if (!read.ok()) return read.error();
        values.assign(indices.size(), std::move(read).value());
        return values;
    }
    for (const EntityIndex index : indices) {
        const Result<AttributeSet> acting = state.definitions.attributes.acting(*state.document.find(index));
        if (!acting.ok()) return acting.error();
        const AttributeEntry* entry = acting.value().find(name);
        Result<attributes::AttributeValue> read =
            read_value(state, name, entry ? with_present(value, attributes::to_json(entry->value)) : value);
        if (!read.ok()) return read.error();
        values.emplace_back(std::move(read).value());
    }
    return values;
}

// Sets a new value of the attribute in each entity, or removes it.
Result<json> change_attribute(SessionState& state, const std::vector<EntityIndex>& indices, const std::string& name,
                              const NewValues& values, const std::string& merge) {
    const AttributeDescription* description = attributes::describe(name);
    const std::string label = description && !description->label.empty() ? description->label : name;
    Edit edit = state.start_edit((values.front() ? "Set " : "Reset ") + label + " of " + state.called(indices));
    edit.merge = merge;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const Entity& before = *state.document.find(indices[i]);
        EntityChange change = change_of(before, before);
        if (values[i]) {
            change.after->attributes[name] = *values[i];
        } else if (change.after->attributes.erase(name) == 0) {
            continue;
        }
        edit.changes.emplace_back(std::move(change));
    }
    return done(state.commit(std::move(edit)));
}

Result<json> set_attribute(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::string name, merge;
    need_indices(reader, state, indices);
    need_text(reader, "name", "an attribute's name", name);
    const json* value = reader.need("value", "the attribute's new value");
    reader.text("merge", merge);
    if (!reader.finish()) return *error;
    const Result<NewValues> values = read_values(state, indices, name, *value);
    if (!values.ok()) return values.error();
    return change_attribute(state, indices, name, values.value(), merge);
}

Result<json> reset_attribute(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::string name;
    need_indices(reader, state, indices);
    need_text(reader, "name", "an attribute's name", name);
    if (!reader.finish()) return *error;
    if (!attributes::describe(name)) return attribute_from_json(name, 0, "name").error();
    return change_attribute(state, indices, name, NewValues(indices.size()), {});
}

struct ActingEntity {
    const Entity* entity;
    AttributeSet attributes;
};

// The entity as it is in the running world, spawned ones too; else as in the document.
Result<ActingEntity> acting_entity(SessionState& state, EntityIndex index) {
    const Entity* entity = state.simulation->definition(index);
    if (!entity) entity = state.document.find(index);
    if (!entity) return state.entity(index, "index").error();
    Result<AttributeSet> acting = state.simulation->attributes(index);
    if (!acting.ok()) acting = state.definitions.attributes.acting(*entity);
    if (!acting.ok()) return acting.error();
    return ActingEntity{entity, std::move(acting).value()};
}

Result<json> list_attributes(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    need_index(reader, "index", index);
    if (!reader.finish()) return *error;

    const Result<ActingEntity> found = acting_entity(state, index);
    if (!found.ok()) return found.error();
    const auto& [entity, acting] = found.value();
    Result<AttributeSet> automatic = state.definitions.attributes.automatic(*entity);
    if (!automatic.ok()) return automatic.error();
    std::vector<std::string> own;
    for (const auto& [name, value] : entity->attributes) own.push_back(name);
    const Result<std::vector<attributes::Issue>> issues = issues_of(state, *entity);
    if (!issues.ok()) return issues.error();
    json rows = attribute_rows(acting, automatic.value(), own, issues.value());
    if (std::holds_alternative<ModelReference>(entity->geometry)) {
        for (json& row : rows) {
            const std::string name = row["name"];
            row["of_model"] = attributes::to_json(value_of_model(name, acting.find(name)->value, entity->scale));
        }
    }
    return json{{"attributes", std::move(rows)}};
}

// Triangles of static things are those that are drawn, and may be many: they are not sent.
Result<json> tell_collision_shape(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    need_index(reader, "index", index);
    if (!reader.finish()) return *error;
    const Result<ActingEntity> found = acting_entity(state, index);
    if (!found.ok()) return found.error();
    const auto& [entity, acting] = found.value();
    if (matter_of(acting) == attributes::Matter::none) return json{{"shape", nullptr}};
    const Result<physics::ShapeDefinition> shape = shape_of(*entity, acting, state.definitions.models);
    if (!shape.ok()) return shape.error();
    return json{{"shape", physics::is_static_only(shape.value()) ? json(nullptr) : shape_to_json(shape.value())}};
}

template <std::size_t count>
json corners_of(const std::vector<std::array<std::uint32_t, count>>& elements) {
    json corners = json::array();
    for (const auto& element : elements)
        for (const std::uint32_t node : element) corners.push_back(node);
    return corners;
}

// The mesh that deforms the drawn form of a deformable entity.
Result<json> tell_simulation_mesh(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    std::uint32_t wanted = 0;
    need_index(reader, "index", index);
    reader.whole("points", wanted);
    if (!reader.finish()) return *error;
    const SoftNodes* soft = as_soft(state.simulation->points(index));
    if (!soft) return json{{"mesh", nullptr}};
    // A sheet that tore later has fewer nodes at the moment that is shown.
    std::size_t points = soft->definition().nodes.size();
    if (wanted > 0) {
        points = wanted;
    } else if (state.past.shown) {
        const auto was = std::ranges::find(state.past.shown->entities, index,
                                           [](const EntityMoment& each) { return each.motion.entity; });
        if (was != state.past.shown->entities.end() && was->points) points = was->points->count();
    }
    const physics::DeformableDefinition form = soft->definition_of(points);
    json mesh = {{"nodes", json::array()}};
    for (const Vec3 node : form.nodes)
        for (const double number : {node.x, node.y, node.z}) mesh["nodes"].push_back(number);
    if (const auto* solid = std::get_if<physics::SoftSolid>(&form.matter))
        mesh["tetrahedra"] = corners_of(solid->tetrahedra);
    else if (const auto* cloth = std::get_if<physics::Cloth>(&form.matter))
        mesh["triangles"] = corners_of(cloth->triangles);
    else
        mesh["broken"] = soft->broken_segments();
    return json{{"mesh", std::move(mesh)}};
}

}  // namespace

std::span<const Command> attribute_commands() {
    static constexpr Command commands[] = {{"entity.set_attribute", set_attribute},
                                           {"entity.reset_attribute", reset_attribute},
                                           {"entity.attributes", list_attributes, Need::look},
                                           {"entity.collision_shape", tell_collision_shape, Need::look},
                                           {"entity.simulation_mesh", tell_simulation_mesh, Need::look}};
    return commands;
}

}  // namespace embody::scene
