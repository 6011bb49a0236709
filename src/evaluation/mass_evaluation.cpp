// SPDX-License-Identifier: MIT
#include "evaluation/mass_evaluation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "evaluation/found_category.h"

namespace embody::evaluation {
namespace {

using attributes::AttributeEntry;
using attributes::AttributeSet;

using Predictions = std::vector<const MassPrediction*>;

// Percentile bootstrap: means of samples of the same size, drawn with replacement.
void put_bootstrap_interval(const Predictions& predictions, MassFigures& figures) {
    constexpr int samples = 2000;
    std::mt19937_64 random(1);
    std::vector<double> means(samples);
    for (double& mean : means) {
        double sum = 0;
        for (std::size_t i = 0; i < predictions.size(); ++i)
            sum += std::abs(predictions[random() % predictions.size()]->log_error());
        mean = sum / static_cast<double>(predictions.size());
    }
    std::ranges::sort(means);
    figures.alde_low = means[samples / 40];
    figures.alde_high = means[samples - 1 - samples / 40];
}

MassFigures figures_of(const Predictions& predictions) {
    MassFigures figures;
    figures.objects = predictions.size();
    if (predictions.empty()) return figures;
    for (const MassPrediction* prediction : predictions) {
        const double error = prediction->log_error();
        figures.alde += std::abs(error);
        figures.bias += error;
        figures.mnre += std::exp(-std::abs(error));
        figures.within_factor_2 += std::abs(error) <= std::log(2.0) ? 1 : 0;
        const double mass = prediction->object.mass;
        figures.coverage_80 += mass >= prediction->low && mass <= prediction->high ? 1 : 0;
    }
    const auto count = static_cast<double>(predictions.size());
    for (double* sum : {&figures.alde, &figures.bias, &figures.mnre, &figures.within_factor_2, &figures.coverage_80})
        *sum /= count;
    put_bootstrap_interval(predictions, figures);
    return figures;
}

std::map<std::string, MassFigures> figures_by(const std::vector<MassPrediction>& predictions,
                                              const std::function<std::string(const MassPrediction&)>& group_of) {
    std::map<std::string, Predictions> groups;
    for (const MassPrediction& prediction : predictions) groups[group_of(prediction)].push_back(&prediction);
    std::map<std::string, MassFigures> figures;
    for (const auto& [group, members] : groups) figures[group] = figures_of(members);
    return figures;
}

// Taxonomies without one category each, made on first use.
class Rest {
public:
    explicit Rest(const attributes::Taxonomy& taxonomy) : taxonomy_(taxonomy) {}
    const attributes::Taxonomy& without(const std::string& category) {
        auto& rest = made_[category];
        if (!rest) rest = taxonomy_.without(category);
        return *rest;
    }

private:
    const attributes::Taxonomy& taxonomy_;
    std::map<std::string, std::unique_ptr<attributes::Taxonomy>> made_;
};

}  // namespace

double MassPrediction::log_error() const { return std::log(mass / object.mass); }

MassEvaluation evaluate_mass(const attributes::Taxonomy& taxonomy, const std::vector<MeasuredObject>& objects,
                             Told told, Words words) {
    MassEvaluation evaluation;
    Rest rest(taxonomy);
    for (const MeasuredObject& object : objects) {
        const attributes::ModelFacts facts = facts_of(object, told);
        AttributeSet set = resolve(taxonomy, facts);
        if (words == Words::unseen) set = resolve(rest.without(set.word("category", "")), facts);
        const AttributeEntry* mass = set.find("mass");
        if (mass == nullptr) {
            evaluation.without_mass.push_back(object.id);
            continue;
        }
        const double value = set.number("mass", 0);
        const AttributeEntry* category = set.find("category");
        evaluation.predictions.push_back({object, value, mass->low.value_or(value), mass->high.value_or(value),
                                          found_category(set), level_name(category->level)});
    }
    std::ranges::stable_sort(evaluation.predictions, std::greater(),
                             [](const MassPrediction& p) { return std::abs(p.log_error()); });

    Predictions all;
    for (const MassPrediction& prediction : evaluation.predictions) all.push_back(&prediction);
    evaluation.all = figures_of(all);
    evaluation.by_source = figures_by(evaluation.predictions, [](const auto& p) { return p.object.source(); });
    evaluation.by_level = figures_by(evaluation.predictions, [](const auto& p) { return p.level; });
    return evaluation;
}

}  // namespace embody::evaluation
