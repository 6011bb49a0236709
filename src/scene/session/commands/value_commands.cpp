// SPDX-License-Identifier: MIT
// What a person does with the values of things besides typing them: presets, copies, and what makes no sense.
#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/material_presets.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/taxonomy_data.h"
#include "scene/file/json/parts.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using attributes::AttributeDescription;
using attributes::AttributeSet;
using attributes::Matter;
using nlohmann::json;

json warning_json(const attributes::Issue& issue) {
    return {{"why", issue.why},
            {"remedy", issue.remedy},
            {"reset", issue.reset.empty() ? json(nullptr) : json(issue.reset)}};
}

Result<std::vector<attributes::Issue>> issues_of(SessionState& state, const Entity& entity) {
    const bool has_joint = !state.lookup.holds.joints_of(entity.index).empty();
    return state.definitions.attributes.contradictions(entity, circumstances_of(state.document.settings, has_joint));
}

namespace {

std::string label_of(const std::string& name) {
    const AttributeDescription* description = attributes::describe(name);
    return description && !description->label.empty() ? description->label : name;
}

Result<const attributes::Taxonomy*> need_taxonomy(const SessionState& state) {
    const Result<catalog::Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    return &catalog.value()->taxonomy();
}

// Warnings ------------------------------------------------------------------------------------------------------------

// Of the entities that are named, or of all. Who has nothing of its own has no warning, and is not looked at.
Result<json> warnings(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    if (params.is_object() && params.contains("indices"))
        need_indices(reader, state, indices);
    else
        for (const Entity& entity : state.document.entities) indices.push_back(entity.index);
    if (!reader.finish()) return *error;

    json list = json::array();
    for (const EntityIndex index : indices) {
        const Entity& entity = *state.document.find(index);
        if (entity.attributes.empty()) continue;
        const Result<std::vector<attributes::Issue>> issues = issues_of(state, entity);
        // What waits for its model has no values yet.
        if (!issues.ok() || issues.value().empty()) continue;
        json told = json::array();
        for (const attributes::Issue& issue : issues.value()) {
            json row = warning_json(issue);
            row["attribute"] = issue.attribute;
            row["label"] = label_of(issue.attribute);
            told.push_back(std::move(row));
        }
        list.push_back({{"index", index}, {"warnings", std::move(told)}});
    }
    return json{{"entities", std::move(list)}};
}

// Presets -------------------------------------------------------------------------------------------------------------

json preset_json(const attributes::MaterialPreset& preset) {
    const attributes::MaterialData& material = *preset.material;
    json values = json::array();
    const auto add = [&values](const char* name, double value, json low, json high) {
        values.push_back({{"name", name},
                          {"label", label_of(name)},
                          {"unit", attributes::describe(name)->unit},
                          {"value", value},
                          {"low", std::move(low)},
                          {"high", std::move(high)}});
    };
    const auto add_interval = [&add](const char* name, const attributes::Interval& of) {
        add(name, of.typical, of.low, of.high);
    };
    add_interval("density", material.density);
    add_interval("friction_static", material.friction_static);
    add_interval("friction_dynamic", material.friction_dynamic);
    add("friction_rolling", material.friction_rolling, nullptr, nullptr);
    add_interval("restitution", material.restitution);
    return {
        {"preset", material.name}, {"label", preset.label}, {"source", material.source}, {"values", std::move(values)}};
}

Result<json> presets(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    const Result<const attributes::Taxonomy*> taxonomy = need_taxonomy(state);
    if (!taxonomy.ok()) return taxonomy.error();
    json list = json::array();
    for (const attributes::MaterialPreset& preset : attributes::material_presets(*taxonomy.value()))
        list.push_back(preset_json(preset));
    return json{{"presets", std::move(list)}};
}

// Materials are of what keeps together: a liquid of steel would be no steel.
Result<void> check_made_of(SessionState& state, EntityIndex index) {
    const Result<AttributeSet> acting = state.definitions.attributes.acting(*state.document.find(index));
    if (!acting.ok()) return acting.error();
    const Matter matter = matter_of(acting.value());
    if (matter != Matter::none && matter != Matter::liquid && matter != Matter::grains) return {};
    const std::string what = matter == Matter::none     ? "is only drawn"
                             : matter == Matter::liquid ? "is a liquid"
                                                        : "is filled with grains";
    return Error{"indices", state.called({index}) + " " + what + ": presets are for solid things",
                 "leave it out, or make its kind rigid first"};
}

// "cast iron" within a sentence.
std::string lower_label(const attributes::MaterialPreset& preset) {
    std::string label = preset.label;
    label.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(label.front())));
    return label;
}

Result<json> apply_preset(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::string name;
    need_indices(reader, state, indices);
    need_text(reader, "preset", "a material's name", name);
    if (!reader.finish()) return *error;
    const Result<const attributes::Taxonomy*> taxonomy = need_taxonomy(state);
    if (!taxonomy.ok()) return taxonomy.error();
    const Result<attributes::MaterialPreset> preset = attributes::preset_named(*taxonomy.value(), name);
    if (!preset.ok()) return preset.error();
    for (const EntityIndex index : indices)
        if (Result<void> solid = check_made_of(state, index); !solid.ok()) return solid.error();

    Edit edit = state.start_edit("Make " + state.called(indices) + " of " + lower_label(preset.value()));
    for (const EntityIndex index : indices) {
        const Entity& before = *state.document.find(index);
        EntityChange change = change_of(before, before);
        for (const char* decided : attributes::decided_by_material) change.after->attributes.erase(decided);
        change.after->attributes["surface_material"] = name;
        edit.changes.emplace_back(std::move(change));
    }
    return done(state.commit(std::move(edit)));
}

// Copies --------------------------------------------------------------------------------------------------------------

// The names to copy: those of the params, or those that a person set for the entity.
Result<std::vector<std::string>> read_names(FieldReader& reader, const json& params, const Entity* from) {
    std::vector<std::string> names;
    if (params.contains("names")) {
        reader.words("names", names);
        for (std::size_t i = 0; reader.ok() && i < names.size(); ++i)
            if (!attributes::describe(names[i]))
                return Error{element_path("names", i), "\"" + names[i] + "\" is no attribute",
                             "entity.attributes lists them"};
        if (reader.ok() && names.empty())
            return Error{"names", "names no attribute", "leave it out for all that were set"};
    } else if (from) {
        for (const auto& [name, value] : from->attributes) names.push_back(name);
        if (names.empty()) return Error{"from", "nothing was set by hand there", "say in names which values to copy"};
    }
    return names;
}

Result<json> copy_attributes(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex from = 0;
    std::vector<EntityIndex> indices;
    need_index(reader, "from", from);
    need_indices(reader, state, indices);
    if (!reader.ok()) return *error;
    const Result<const Entity*> source = state.entity(from, "from");
    if (!source.ok()) return source.error();
    const Result<std::vector<std::string>> names = read_names(reader, params, source.value());
    if (!reader.finish()) return *error;
    if (!names.ok()) return names.error();
    const Result<AttributeSet> given = state.definitions.attributes.acting(*source.value());
    if (!given.ok()) return given.error();

    // What does not concern the kind of a thing is left out there, and told.
    std::erase(indices, from);
    if (indices.empty()) return Error{"indices", "names only the thing to copy from", "name others"};
    Edit edit = state.start_edit("Copy values of " + state.called({from}) + " to " + state.called(indices));
    json skipped = json::array();
    std::size_t copied = 0;
    for (const EntityIndex index : indices) {
        const Entity& before = *state.document.find(index);
        const Result<AttributeSet> acting = state.definitions.attributes.acting(before);
        if (!acting.ok()) return acting.error();
        EntityChange change = change_of(before, before);
        // The kind goes first: it decides what concerns the thing.
        const bool takes_kind = std::ranges::find(names.value(), "kind") != names.value().end();
        const attributes::PhysicalKind kind = takes_kind ? kind_of(given.value()) : kind_of(acting.value());
        for (const std::string& name : names.value()) {
            const attributes::AttributeEntry* entry = given.value().find(name);
            if (!entry || !attributes::applies_to(*attributes::describe(name), kind)) {
                skipped.push_back({{"index", index}, {"name", name}, {"label", label_of(name)}});
                continue;
            }
            change.after->attributes[name] = entry->value;
            ++copied;
        }
        if (change.after->attributes != before.attributes) edit.changes.emplace_back(std::move(change));
    }
    if (Result<void> made = state.commit(std::move(edit)); !made.ok()) return made.error();
    return json{{"copied", copied}, {"skipped", std::move(skipped)}};
}

}  // namespace

std::span<const Command> value_commands() {
    static constexpr Command commands[] = {{"entity.warnings", warnings, Need::look},
                                           {"entity.presets", presets, Need::look},
                                           {"entity.apply_preset", apply_preset},
                                           {"entity.copy_attributes", copy_attributes}};
    return commands;
}

}  // namespace embody::scene
