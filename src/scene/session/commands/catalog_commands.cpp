// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "attributes/assemble.h"
#include "attributes/plausible.h"
#include "scene/file/json/parts.h"
#include "scene/session/commands/commands.h"
#include "scene/session/model_json.h"

namespace embody::scene {

using attributes::AttributeSet;
using catalog::ModelSummary;
using nlohmann::json;

Result<catalog::Catalog*> open_catalog(const SessionState& state) {
    if (state.catalog) return state.catalog;
    return Error{"catalog", "no model database is open", "start with --database FILE"};
}

// The attributes in effect, and without those that a person set.
Result<json> model_attribute_rows(const catalog::Catalog& catalog, std::int64_t id) {
    const Result<AttributeSet> acting = catalog.attributes(id);
    if (!acting.ok()) return acting.error();
    const Result<AttributeSet> automatic = catalog.automatic_attributes(id);
    if (!automatic.ok()) return automatic.error();
    std::vector<std::string> own;
    for (const attributes::AttributeEntry& entry : acting.value().entries())
        if (entry.level == attributes::AttributeLevel::manual) own.push_back(entry.name);
    std::vector<attributes::Issue> issues = attributes::find_implausible(acting.value(), automatic.value(), {});
    for (attributes::Issue& issue : issues)
        if (attributes::is_manual(acting.value(), issue.attribute)) attributes::offer_reset(issue, automatic.value());
    return attribute_rows(acting.value(), automatic.value(), own, issues);
}

namespace {

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

Result<json> model(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string key;
    need_text(reader, "key", "a model's key", key);
    if (!reader.finish()) return *error;
    const Result<catalog::Catalog*> catalog = open_catalog(state);
    if (!catalog.ok()) return catalog.error();
    const Result<ModelSummary> found = catalog.value()->model(key);
    if (!found.ok()) return found.error();
    Result<json> rows = model_attribute_rows(*state.catalog, found.value().id);
    if (!rows.ok()) return rows.error();
    return json{{"model", model_to_json(found.value())}, {"attributes", std::move(rows).value()}};
}

}  // namespace

std::span<const Command> catalog_commands() {
    static constexpr Command commands[] = {{"catalog.search", search, Need::look},
                                           {"catalog.categories", categories, Need::look},
                                           {"catalog.model", model, Need::look}};
    return commands;
}

}  // namespace embody::scene
