// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "scene/commands/commands.h"
#include "scene/json/parts.h"
#include "scene/model_json.h"

namespace embody::scene {

using attributes::AttributeSet;
using catalog::ModelSummary;
using nlohmann::json;

namespace {

Result<catalog::Catalog*> open_catalog(const SessionState& state) {
    if (state.catalog) return state.catalog;
    return Error{"catalog", "no model database is open", "start with --database FILE"};
}

Result<json> search(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    catalog::SearchQuery query;
    reader.text("words", query.words);
    reader.text("category", query.category);
    reader.whole("limit", query.limit, 1, 1000);
    reader.whole("offset", query.offset, 0, 1 << 30);
    if (!reader.finish()) return *error;
    const Result<catalog::Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const Result<catalog::SearchPage> page = catalog.value()->search(query);
    if (!page.ok()) return page.error();
    json models = json::array();
    for (const ModelSummary& model : page.value().models) models.push_back(model_to_json(model));
    return json{{"models", std::move(models)}, {"total", page.value().total}};
}

Result<json> categories(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    const Result<catalog::Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const Result<std::vector<catalog::CategoryCount>> counts = catalog.value()->categories();
    if (!counts.ok()) return counts.error();
    json list = json::array();
    for (const catalog::CategoryCount& count : counts.value())
        list.push_back({{"category", count.category}, {"models", count.models}});
    return json{{"categories", std::move(list)}};
}

// The attributes of a model as they act, and without what a person set.
Result<json> rows_of(const catalog::Catalog& catalog, std::int64_t id) {
    const Result<AttributeSet> acting = catalog.attributes(id);
    if (!acting.ok()) return acting.error();
    const Result<AttributeSet> automatic = catalog.automatic_attributes(id);
    if (!automatic.ok()) return automatic.error();
    std::vector<std::string> own;
    for (const attributes::AttributeEntry& entry : acting.value().entries())
        if (entry.level == attributes::AttributeLevel::manual) own.push_back(entry.name);
    return attribute_rows(acting.value(), automatic.value(), own);
}

Result<ModelSummary> need_model(SessionState& state, FieldReader& reader) {
    std::string key;
    need_text(reader, "key", "a model's key", key);
    if (!reader.ok()) return *reader.error();
    const Result<catalog::Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    return catalog.value()->model(key);
}

Result<json> model(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const Result<ModelSummary> found = need_model(state, reader);
    if (!found.ok()) return found.error();
    if (!reader.finish()) return *error;
    Result<json> rows = rows_of(*state.catalog, found.value().id);
    if (!rows.ok()) return rows.error();
    return json{{"model", model_to_json(found.value())}, {"attributes", std::move(rows).value()}};
}

// The model is another one now: what was made of it while nothing runs is made again.
Result<json> after_change(SessionState& state, const ModelSummary& model) {
    state.bodies.forget(model.key);
    state.simulation_is_pristine = false;
    if (state.play_state == PlayState::stopped) {
        if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made.error();
    }
    Result<json> rows = rows_of(*state.catalog, model.id);
    if (!rows.ok()) return rows.error();
    return json{{"attributes", std::move(rows).value()}};
}

// Which attribute of which model a command means.
struct AttributeOfModel {
    ModelSummary model;
    std::string name;
};
Result<AttributeOfModel> need_attribute(SessionState& state, FieldReader& reader) {
    Result<ModelSummary> found = need_model(state, reader);
    if (!found.ok()) return found.error();
    AttributeOfModel meant{std::move(found).value(), {}};
    need_text(reader, "name", "an attribute's name", meant.name);
    return meant;
}

Result<json> set_attribute(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const Result<AttributeOfModel> meant = need_attribute(state, reader);
    if (!meant.ok()) return meant.error();
    const auto& [model, name] = meant.value();
    const json* value = reader.need("value", "the attribute's new value");
    if (!reader.finish()) return *error;
    const Result<attributes::AttributeValue> read = attribute_from_json(name, *value, "value");
    if (!read.ok()) return read.error();
    if (Result<void> set = state.catalog->set_attribute(model.id, name, read.value()); !set.ok()) return set.error();
    return after_change(state, model);
}

Result<json> reset_attribute(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const Result<AttributeOfModel> meant = need_attribute(state, reader);
    if (!meant.ok()) return meant.error();
    if (!reader.finish()) return *error;
    const auto& [model, name] = meant.value();
    if (Result<void> reset = state.catalog->reset_attribute(model.id, name); !reset.ok()) return reset.error();
    return after_change(state, model);
}

constexpr Command commands[] = {{"catalog.search", search},
                                {"catalog.categories", categories},
                                {"catalog.model", model},
                                {"catalog.set_attribute", set_attribute},
                                {"catalog.reset_attribute", reset_attribute}};

}  // namespace

std::span<const Command> catalog_commands() { return commands; }

}  // namespace embody::scene
