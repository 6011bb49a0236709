// SPDX-License-Identifier: MIT
#include "evaluation/catalogue_evaluation.h"

#include <algorithm>
#include <optional>

#include "attributes/physical_kind.h"
#include "evaluation/found_category.h"

namespace embody::evaluation {
namespace {

using attributes::AttributeSet;
using attributes::ModelFacts;

double fraction(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// The model's kind without the catalogue's flag. For doors and windows the catalogue's own category says that they do
// not move.
void compare_movable(const attributes::Taxonomy& taxonomy, ModelFacts facts, const std::string& key,
                     CatalogueEvaluation& evaluation) {
    if (!facts.movable) return;
    const bool catalogue_says = *facts.movable && !facts.door_or_window;
    facts.movable.reset();
    facts.door_or_window = false;
    const AttributeSet set = resolve(taxonomy, facts);
    ++evaluation.flagged;
    if (!is_static(kind_of(set)) != catalogue_says) {
        evaluation.disagreements.push_back({key, facts.name, found_category(set), catalogue_says});
    }
}

void evaluate_model(const attributes::Taxonomy& taxonomy, const ModelFacts& facts, const std::string& key,
                    CatalogueEvaluation& evaluation) {
    const AttributeSet set = resolve(taxonomy, facts);
    const attributes::AttributeLevel level = set.find("category")->level;
    ++evaluation.models;
    ++evaluation.by_level[level_name(level)];
    if (level == attributes::AttributeLevel::standard) evaluation.unknown.push_back(facts.name);
    compare_movable(taxonomy, facts, key, evaluation);
    const auto sum = density_sum(taxonomy, facts);
    if (const double mass = set.number("mass", 0); sum && mass > 0) evaluation.density_sums.push_back(*sum / mass);
    if (auto issues = check(set, facts); !issues.empty()) evaluation.broken.push_back({key, std::move(issues)});
}

}  // namespace

double CatalogueEvaluation::above_default() const { return fraction(models - unknown.size(), models); }

double CatalogueEvaluation::movable_agreement() const { return fraction(flagged - disagreements.size(), flagged); }

double CatalogueEvaluation::median_density_sum() const {
    return density_sums.empty() ? 0 : density_sums[density_sums.size() / 2];
}

double CatalogueEvaluation::density_sums_within_factor_2() const {
    const auto within = [](double ratio) { return ratio >= 0.5 && ratio <= 2; };
    return fraction(static_cast<std::size_t>(std::ranges::count_if(density_sums, within)), density_sums.size());
}

Result<CatalogueEvaluation> evaluate_catalogue(const attributes::Taxonomy& taxonomy, const catalog::Catalog& catalog) {
    CatalogueEvaluation evaluation;
    catalog::SearchQuery query{.limit = 1000};
    for (;;) {
        const auto page = catalog.search(query);
        if (!page) return page.error();
        for (const catalog::ModelSummary& model : page->models) {
            const auto facts = catalog.facts(model.id);
            if (!facts) return facts.error();
            evaluate_model(taxonomy, *facts, model.key, evaluation);
        }
        query.offset += query.limit;
        if (page->models.empty() || query.offset >= page->total) break;
    }
    std::ranges::sort(evaluation.density_sums);
    return evaluation;
}

}  // namespace embody::evaluation
