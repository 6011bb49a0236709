// SPDX-License-Identifier: MIT
#include "catalog/describe_many.h"

#include <tuple>

#include "catalog/describe_model.h"
#include "catalog/knowledge_json.h"

namespace embody::catalog {
namespace {

void apply_variant(database::ModelRow& row, attributes::ModelFacts& facts, const ModelVariant& variant) {
    row.id = 0;
    row.key = variant.key;
    row.name = facts.name = valid_utf8(variant.name);
    facts.tags = variant.tags;
    row.tags = variant.tags;
    if (!facts.catalogue_category.empty()) row.tags.push_back(facts.catalogue_category);
    if (!variant.material_names.empty()) facts.material_names = variant.material_names;
    for (double& length : row.size) length *= variant.scale;
    facts.geometry = attributes::scaled(facts.geometry, variant.scale);
}

void describe_one(Description& model, const attributes::Taxonomy& taxonomy) {
    auto facts = facts_from_json(model.knowledge.facts);
    if (!facts) {
        model.problem = facts.error();
        return;
    }
    if (model.variant) apply_variant(model.row, *facts, *model.variant);
    const auto words = [&] { return std::tuple(model.row.category, model.row.subcategory, model.row.physical_kind); };
    const auto before = words();
    model.knowledge = describe(model.row, *facts, taxonomy, model.manual);
    model.row_is_new = words() != before;
}

}  // namespace

void describe_all(std::span<Description> models, const attributes::Taxonomy& taxonomy, TaskPool& workers) {
    parallel_for(workers, models.size(), models.size() > 1, [&](int, IndexRange range) {
        for (Description& model : models.subspan(range.first, range.last - range.first)) describe_one(model, taxonomy);
    });
}

}  // namespace embody::catalog
