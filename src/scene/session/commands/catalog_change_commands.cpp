// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>

#include "attributes/attribute_json.h"
#include "attributes/registry.h"
#include "scene/file/json/parts.h"
#include "scene/session/catalog_edit.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using catalog::AttributeChange;
using catalog::Catalog;
using catalog::ChangeBatchRecord;
using catalog::ChangeRecord;
using catalog::ChangeReport;
using nlohmann::json;

namespace {

constexpr std::size_t max_keys = 10'000;
/// Maximum number of changes in one answer with the history: some megabytes.
constexpr std::size_t max_told_changes = 20'000;
/// Number of models that a preview names; the history has all.
constexpr std::size_t max_listed = 20;

// Reading
// --------------------------------------------------------------------------------------------------------------

Result<std::vector<std::int64_t>> ids_of(const Catalog& catalog, const json& keys, FieldReader& reader) {
    const std::string where = reader.path("keys");
    if (!read_array(keys, where, reader.error())) return *reader.error();
    if (keys.empty() || keys.size() > max_keys)
        return Error{where, "must name 1 … 10000 models", "a search or a category can mean more"};
    std::vector<std::int64_t> ids;
    std::set<std::int64_t> known;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!keys[i].is_string()) return Error{element_path(where, i), "must be a model's key"};
        const auto model = catalog.model(keys[i].get<std::string>());
        if (!model.ok()) return Error{element_path(where, i), model.error().why, model.error().remedy};
        if (known.insert(model.value().id).second) ids.push_back(model.value().id);
    }
    return ids;
}

// {"keys": […]}, {"words", "category"} as a search has them, or {"all": true}: changing everything must be explicit.
Result<Catalog::ModelChoice> read_models(const Catalog& catalog, const json& models) {
    std::optional<Error> error;
    FieldReader reader(models, "models", error);
    const json* keys = reader.take("keys");
    catalog::SearchQuery query;
    bool all = false;
    reader.text("words", query.words);
    reader.text("category", query.category);
    reader.truth("all", all);
    if (!reader.finish()) return *error;
    const bool searched = !query.words.empty() || !query.category.empty();
    if ((keys != nullptr) + searched + all != 1)
        return Error{"models", "must say which: keys, or words and category, or all",
                     R"(for example {"category": "chair"})"};
    if (!keys) return Catalog::ModelChoice(query);
    auto ids = ids_of(catalog, *keys, reader);
    if (!ids.ok()) return ids.error();
    return Catalog::ModelChoice(std::move(ids).value());
}

// [{"name", "value"}…]; null resets to the automatic value.
Result<std::vector<AttributeChange>> read_changes(const json& list) {
    std::optional<Error> error;
    if (!read_array(list, "attributes", error)) return *error;
    std::vector<AttributeChange> changes;
    for (std::size_t i = 0; i < list.size(); ++i) {
        FieldReader reader(list[i], element_path("attributes", i), error);
        AttributeChange change;
        need_text(reader, "name", "an attribute's name", change.name);
        const json* value = reader.need("value", "the new value, or null for the automatic one");
        if (!reader.finish()) return *error;
        const auto read = attribute_from_json(change.name, value->is_null() ? json(0) : *value, reader.path("value"));
        if (!value->is_null()) {
            if (!read.ok()) return read.error();
            change.value = read.value();
        } else if (!attributes::describe(change.name)) {
            return read.error();
        }
        changes.push_back(std::move(change));
    }
    return changes;
}

// Messages
// --------------------------------------------------------------------------------------------------------------

// Effect on the open scene: how many entities take the new values, and how many have a value of their own.
json affected_entities(const SessionState& state, const ChangeReport& report) {
    std::set<std::string> keys;
    for (const catalog::ChangedModel& model : report.models) keys.insert(model.key);
    std::size_t following = 0, keeping = 0;
    for (const Entity& entity : state.document.entities) {
        const auto* model = std::get_if<ModelReference>(&entity.geometry);
        if (!model || !keys.contains(model->key)) continue;
        const bool own = std::all_of(report.attributes.begin(), report.attributes.end(),
                                     [&](const std::string& name) { return entity.attributes.contains(name); });
        ++(own ? keeping : following);
    }
    return {{"following", following}, {"keeping", keeping}};
}

json report_json(const SessionState& state, const ChangeReport& report, bool dry_run) {
    json models = json::array(), refused = json::array();
    for (std::size_t i = 0; i < report.models.size() && i < max_listed; ++i)
        models.push_back({{"key", report.models[i].key}, {"name", report.models[i].name}});
    for (std::size_t i = 0; i < report.refused.size() && i < max_listed; ++i) {
        const catalog::RefusedChange& one = report.refused[i];
        refused.push_back({{"key", one.key}, {"name", one.name}, {"attribute", one.attribute}, {"why", one.why}});
    }
    return {{"batch", report.batch != 0 ? json(report.batch) : json(nullptr)},
            {"command", report.command},
            {"label", report.models.empty() ? "" : label_of(report)},
            {"dry_run", dry_run},
            {"chosen", report.chosen},
            {"changed", report.models.size()},
            {"values", report.values},
            {"unchanged", report.unchanged},
            {"refused", report.refused.size()},
            {"models", std::move(models)},
            {"refusals", std::move(refused)},
            {"entities", affected_entities(state, report)}};
}

std::string time_text(std::int64_t seconds) {
    const std::time_t time = seconds;
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

json batch_json(const ChangeBatchRecord& batch) {
    const auto number = [](std::int64_t held) { return held != 0 ? json(held) : json(nullptr); };
    const auto value = [](const auto& held) { return held ? attributes::to_json(*held) : json(nullptr); };
    const ChangeRecord& first = batch.changes.front();
    json changes = json::array();
    for (const ChangeRecord& change : batch.changes) {
        const attributes::AttributeDescription* description = attributes::describe(change.attribute);
        changes.push_back({{"key", change.model_key},
                           {"name", change.model_name},
                           {"attribute", change.attribute},
                           {"label", description ? description->label : change.attribute},
                           {"unit", description ? description->unit : ""},
                           {"before", value(change.before)},
                           {"after", value(change.after)}});
    }
    return {{"batch", first.batch},           {"time", time_text(first.made_at)},
            {"person", first.author.person},  {"session", first.author.session},
            {"command", first.command},       {"asked", first.asked},
            {"undoes", number(first.undoes)}, {"undone_by", number(first.undone_by)},
            {"values", batch.values},         {"models", batch.models},
            {"changes", std::move(changes)}};
}

// Commands
// -------------------------------------------------------------------------------------------------------------

Result<json> change(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    catalog::ChangeOptions options;
    const json* models = reader.need("models", "which models: keys, words and category, or all");
    const json* attributes = reader.need("attributes", "a list of names and values");
    reader.truth("skip", options.skip_refused);
    reader.truth("dry_run", options.dry_run);
    if (!reader.finish()) return *error;
    const Result<Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const auto changes = read_changes(*attributes);
    if (!changes.ok()) return changes.error();
    const auto choice = read_models(*catalog.value(), *models);
    if (!choice.ok()) return choice.error();
    const Result<ChangeReport> report = change_models(state, choice.value(), changes.value(), options);
    if (!report.ok()) return report.error();
    return report_json(state, report.value(), options.dry_run);
}

Result<json> undo(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t batch = 0;
    if (reader.need("batch", "the number of a batch of changes")) reader.whole("batch", batch, 1);
    if (!reader.finish()) return *error;
    const Result<ChangeReport> report = undo_models(state, batch);
    if (!report.ok()) return report.error();
    return report_json(state, report.value(), false);
}

Result<json> history(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    catalog::BatchQuery query;
    std::uint32_t before = 0;
    reader.text("key", query.model_key);
    reader.whole("before", before);
    reader.whole("limit", query.limit, 1, 1000);
    reader.whole("changes", query.changes, 1, 1000);
    if (!reader.finish()) return *error;
    const auto told = static_cast<std::size_t>(query.limit) * static_cast<std::size_t>(query.changes);
    if (told > max_told_changes) {
        return Error{"limit", "times changes must be at most " + std::to_string(max_told_changes),
                     "ask for the older ones with before"};
    }
    query.before = before;
    const Result<Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const auto batches = catalog.value()->history_batches(query);
    if (!batches.ok()) return batches.error();
    json list = json::array();
    for (const ChangeBatchRecord& batch : batches.value()) list.push_back(batch_json(batch));
    return json{{"batches", std::move(list)}};
}

// The change to be stopped is the command before this one, which has ended by now: the owner of the session watches for
// this command meanwhile.
Result<json> stop(SessionState&, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    return json::object();
}

// Sets or resets one value of one model; a refusal is an error.
Result<json> change_one(SessionState& state, const json& params, bool gives_value) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string key;
    AttributeChange change;
    need_text(reader, "key", "a model's key", key);
    need_text(reader, "name", "an attribute's name", change.name);
    const json* value = gives_value ? reader.need("value", "the attribute's new value") : nullptr;
    if (!reader.finish()) return *error;
    const Result<Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const auto model = catalog.value()->model(key);
    if (!model.ok()) return model.error();
    if (value) {
        const auto read = attribute_from_json(change.name, *value, "value");
        if (!read.ok()) return read.error();
        change.value = read.value();
    }
    const Result<ChangeReport> report = change_models(state, std::vector{model.value().id}, {change}, {});
    if (!report.ok()) return report.error();
    if (!report.value().refused.empty()) {
        const catalog::RefusedChange& refused = report.value().refused.front();
        return Error{refused.attribute, refused.why + ", as " + refused.name + " is"};
    }
    Result<json> rows = model_attribute_rows(*catalog.value(), model.value().id);
    if (!rows.ok()) return rows.error();
    return json{{"attributes", std::move(rows).value()},
                {"batch", report.value().batch != 0 ? json(report.value().batch) : json(nullptr)}};
}

Result<json> set_model_attribute(SessionState& state, const json& params) { return change_one(state, params, true); }
Result<json> reset_model_attribute(SessionState& state, const json& params) { return change_one(state, params, false); }

}  // namespace

std::span<const Command> catalog_change_commands() {
    static constexpr Command commands[] = {{"catalog.change", change},
                                           {"catalog.undo", undo},
                                           {"catalog.history", history, Need::look},
                                           {"catalog.stop", stop, Need::look},
                                           {"catalog.set_attribute", set_model_attribute},
                                           {"catalog.reset_attribute", reset_model_attribute}};
    return commands;
}

}  // namespace embody::scene
