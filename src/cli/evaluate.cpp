// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "attributes/physical_kind.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"
#include "evaluation/behaviour_evaluation.h"
#include "evaluation/catalogue_evaluation.h"
#include "evaluation/kind_evaluation.h"
#include "evaluation/mass_evaluation.h"

namespace embody::cli {
namespace {

using evaluation::BehaviourEvaluation;
using evaluation::CatalogueEvaluation;
using evaluation::KindEvaluation;
using evaluation::MassEvaluation;
using evaluation::MassFigures;
using evaluation::MassPrediction;

nlohmann::json figures_to_json(const MassFigures& figures) {
    return {{"objects", figures.objects},
            {"alde", figures.alde},
            {"alde_95", {figures.alde_low, figures.alde_high}},
            {"bias", figures.bias},
            {"mnre", figures.mnre},
            {"within_factor_2", figures.within_factor_2},
            {"coverage_80", figures.coverage_80}};
}

nlohmann::json groups_to_json(const std::map<std::string, MassFigures>& groups) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [group, figures] : groups) json[group] = figures_to_json(figures);
    return json;
}

nlohmann::json mass_to_json(const MassEvaluation& evaluation) {
    nlohmann::json rows = nlohmann::json::array();
    for (const MassPrediction& prediction : evaluation.predictions) {
        rows.push_back({{"id", prediction.object.id},
                        {"name", prediction.object.name},
                        {"category", prediction.category},
                        {"level", prediction.level},
                        {"mass_kg", prediction.object.mass},
                        {"predicted_kg", prediction.mass},
                        {"predicted_80_kg", {prediction.low, prediction.high}}});
    }
    return {{"all", figures_to_json(evaluation.all)},
            {"by_source", groups_to_json(evaluation.by_source)},
            {"by_level", groups_to_json(evaluation.by_level)},
            {"without_mass", evaluation.without_mass},
            {"predictions", std::move(rows)}};
}

void print_figures(const std::string& group, const MassFigures& figures) {
    print_text("{} {:>7}  {:.3f} [{:.2f} … {:.2f}]  {:+.2f}  {:.3f}  {:>6.1f} %  {:>9.1f} %\n", padded(group, 16),
               figures.objects, figures.alde, figures.alde_low, figures.alde_high, figures.bias, figures.mnre,
               100 * figures.within_factor_2, 100 * figures.coverage_80);
}

void print_mass(const MassEvaluation& evaluation, std::size_t worst) {
    print_text("{} {:>7}  {}  {}  {}  {}  {}\n", padded("", 16), "objects", padded("ALDE  [95 %]", 19), " bias",
               "MnRE ", "within ×2", "in 80 % interval");
    print_figures("all", evaluation.all);
    for (const auto* groups : {&evaluation.by_source, &evaluation.by_level}) {
        print_line("");
        for (const auto& [group, figures] : *groups) print_figures("  " + group, figures);
    }
    if (!evaluation.without_mass.empty()) {
        std::string ids;
        for (const std::string& id : evaluation.without_mass) ids += " " + id;
        print_text("\nWithout a mass, not counted:{}\n", ids);
    }
    if (worst == 0) return;
    print_text("\nWorst:\n{:>10}  {:>10}  {}  {}\n", "real kg", "predicted", padded("taken for", 22), "name");
    for (std::size_t i = 0; i < std::min(worst, evaluation.predictions.size()); ++i) {
        const MassPrediction& prediction = evaluation.predictions[i];
        print_text("{:>10.4g}  {:>10.4g}  {}  {} ({})\n", prediction.object.mass, prediction.mass,
                   padded(prediction.category, 22), shortened(prediction.object.name, 60), prediction.object.id);
    }
}

nlohmann::json catalogue_to_json(const CatalogueEvaluation& evaluation) {
    nlohmann::json disagreements = nlohmann::json::array(), broken = nlohmann::json::array();
    for (const auto& model : evaluation.disagreements) {
        disagreements.push_back({{"key", model.key},
                                 {"name", model.name},
                                 {"category", model.category},
                                 {"catalogue_says_movable", model.catalogue_says_movable}});
    }
    for (const auto& model : evaluation.broken) {
        nlohmann::json issues = nlohmann::json::array();
        for (const attributes::Issue& issue : model.issues)
            issues.push_back({{"attribute", issue.attribute}, {"why", issue.why}});
        broken.push_back({{"key", model.key}, {"issues", std::move(issues)}});
    }
    return {{"models", evaluation.models},
            {"above_default", evaluation.above_default()},
            {"by_level", evaluation.by_level},
            {"unknown", evaluation.unknown},
            {"movable",
             {{"models", evaluation.flagged},
              {"agreement", evaluation.movable_agreement()},
              {"disagreements", std::move(disagreements)}}},
            {"density_sum",
             {{"models", evaluation.density_sums.size()},
              {"median_ratio", evaluation.median_density_sum()},
              {"within_factor_2", evaluation.density_sums_within_factor_2()}}},
            {"broken", std::move(broken)}};
}

void print_catalogue(const CatalogueEvaluation& evaluation) {
    print_text("{} models; category better than default: {:.1f} %\n", evaluation.models,
               100 * evaluation.above_default());
    for (const auto& [level, models] : evaluation.by_level) print_text("  {} {:>6}\n", padded(level, 14), models);
    for (const std::string& name : evaluation.unknown) print_text("  unknown: {}\n", name);
    print_text("static or movable as {} catalogue entries say: {:.1f} %\n", evaluation.flagged,
               100 * evaluation.movable_agreement());
    for (const auto& model : evaluation.disagreements) {
        print_text("  {} {} taken for {}\n",
                   model.catalogue_says_movable ? "movable:" : "static: ", padded(model.name, 34), model.category);
    }
    print_text(
        "density sum over the parts, at usual walls, of {} models: {:.2f} of the mass at the median, "
        "within a factor 2 for {:.0f} %\n",
        evaluation.density_sums.size(), evaluation.median_density_sum(),
        100 * evaluation.density_sums_within_factor_2());
    print_text("models whose attributes contradict each other: {}\n", evaluation.broken.size());
    for (const auto& model : evaluation.broken)
        for (const attributes::Issue& issue : model.issues)
            print_text("  {}: {}: {}\n", model.key, issue.attribute, issue.why);
}

int evaluate_masses(const EvaluateArguments& arguments, const attributes::Taxonomy& taxonomy) {
    const auto objects = evaluation::read_measured_objects(arguments.truth);
    if (!objects) return report(objects.error());
    const evaluation::Told told = arguments.told == "name"       ? evaluation::Told::name
                                  : arguments.told == "category" ? evaluation::Told::category
                                                                 : evaluation::Told::everything;
    const auto words = arguments.unseen ? evaluation::Words::unseen : evaluation::Words::known;
    const MassEvaluation result = evaluation::evaluate_mass(taxonomy, *objects, told, words);
    if (arguments.json)
        print_json(mass_to_json(result));
    else
        print_mass(result, static_cast<std::size_t>(arguments.worst));
    return exit_ok;
}

std::vector<std::string> names_of(const std::vector<attributes::PhysicalKind>& kinds) {
    std::vector<std::string> names;
    for (const attributes::PhysicalKind kind : kinds) names.push_back(to_text(kind));
    return names;
}

nlohmann::json kinds_to_json(const KindEvaluation& evaluation) {
    nlohmann::json by_label = nlohmann::json::object(), mistakes = nlohmann::json::array();
    for (const auto& [label, counts] : evaluation.by_label)
        by_label[to_text(label)] = {{"words", counts.first}, {"right", counts.second}};
    for (const evaluation::KindMistake& mistake : evaluation.mistakes) {
        mistakes.push_back({{"word", mistake.label.word},
                            {"right", names_of(mistake.label.kinds)},
                            {"kind", to_text(mistake.kind)},
                            {"category", mistake.category}});
    }
    return {{"words", evaluation.words},
            {"accuracy", evaluation.accuracy()},
            {"by_label", std::move(by_label)},
            {"mistakes", std::move(mistakes)}};
}

void print_kinds(const KindEvaluation& evaluation) {
    print_text("kind as {} labelled words say: {:.1f} %\n", evaluation.words, 100 * evaluation.accuracy());
    for (const auto& [label, counts] : evaluation.by_label)
        print_text("  {} {:>6} of {:>6}\n", padded(to_text(label), 14), counts.second, counts.first);
    for (const evaluation::KindMistake& mistake : evaluation.mistakes) {
        print_text("  {} is {}, not {}: taken for {}\n", padded(mistake.label.word, 26),
                   to_text(mistake.label.kinds.front()), to_text(mistake.kind), mistake.category);
    }
}

int evaluate_models(const EvaluateArguments& arguments, const attributes::Taxonomy& taxonomy) {
    const auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    const auto result = evaluation::evaluate_catalogue(taxonomy, **catalog);
    if (!result) return report(result.error());
    std::optional<KindEvaluation> kinds;
    if (!arguments.kinds.empty()) {
        const auto words = evaluation::read_labelled_words(arguments.kinds);
        if (!words) return report(words.error());
        kinds = evaluation::evaluate_kinds(taxonomy, *words);
    }
    if (arguments.json) {
        nlohmann::json json = catalogue_to_json(*result);
        if (kinds) json["kinds"] = kinds_to_json(*kinds);
        print_json(json);
        return exit_ok;
    }
    print_catalogue(*result);
    if (kinds) print_kinds(*kinds);
    return exit_ok;
}

nlohmann::json verdict_to_json(const BehaviourEvaluation::Verdict& verdict) {
    nlohmann::json wrong = nlohmann::json::array();
    for (const evaluation::Behaviour* model : verdict.wrong) wrong.push_back(model->key);
    return {{"judged", verdict.judged}, {"wrong", std::move(wrong)}};
}

void print_verdict(const char* what, const BehaviourEvaluation::Verdict& verdict,
                   const std::function<std::string(const evaluation::Behaviour&)>& say) {
    print_text("{}: {} of {}\n", what, verdict.judged - verdict.wrong.size(), verdict.judged);
    for (const evaluation::Behaviour* model : verdict.wrong)
        print_text("  {} {} {}\n", padded(model->name, 32), padded(model->category, 22), say(*model));
}

std::string compared_text(const evaluation::Compared& compared) {
    return fmt::format("{:.4g}, expected {:.4g}", compared.measured, compared.expected);
}

void print_behaviour(const BehaviourEvaluation& evaluation) {
    using evaluation::Behaviour;
    print_verdict("mass is the attribute's", evaluation.masses(),
                  [](const Behaviour& m) { return compared_text(m.mass) + " kg"; });
    print_verdict("at rest after 5 s", evaluation.resting(),
                  [](const Behaviour& m) { return fmt::format("{:.3g} m/s", m.speed); });
    print_verdict("furniture that does not tip by itself", evaluation.furniture(),
                  [](const Behaviour& m) { return fmt::format("leans {:.0f} degrees", m.tilt); });
    print_verdict("stopping distance follows from friction", evaluation.slides(),
                  [](const Behaviour& m) { return compared_text(*m.slide) + " m"; });
    print_verdict("rebound follows from restitution", evaluation.rebounds(),
                  [](const Behaviour& m) { return compared_text(*m.rebound); });
    print_text("could not be simulated: {}\n", evaluation.failures.size());
    for (const auto& [key, error] : evaluation.failures) print_text("  {}: {}\n", key, error.message());
}

int evaluate_behaviours(const EvaluateArguments& arguments) {
    const auto catalog = open_catalog(arguments.database);
    if (!catalog) return report(catalog.error());
    ProgressBar bar("Simulating");
    const auto result =
        evaluation::evaluate_behaviour(**catalog, static_cast<std::size_t>(arguments.limit),
                                       [&](std::size_t done, std::size_t total) { bar.show(done, total, ""); });
    bar.finish();
    if (!result) return report(result.error());
    if (!arguments.json) {
        print_behaviour(*result);
        return exit_ok;
    }
    nlohmann::json failures = nlohmann::json::array();
    for (const auto& [key, error] : result->failures) failures.push_back({{"key", key}, {"error", error.message()}});
    print_json({{"models", result->models.size()},
                {"mass", verdict_to_json(result->masses())},
                {"at_rest", verdict_to_json(result->resting())},
                {"furniture_stands", verdict_to_json(result->furniture())},
                {"slide", verdict_to_json(result->slides())},
                {"rebound", verdict_to_json(result->rebounds())},
                {"failures", std::move(failures)}});
    return exit_ok;
}

}  // namespace

int run_evaluate(const EvaluateArguments& arguments) {
    if (arguments.what == "behaviour") return evaluate_behaviours(arguments);
    const auto taxonomy = attributes::Taxonomy::load(data_folder() / "taxonomy");
    if (!taxonomy) return report(taxonomy.error());
    return arguments.what == "mass" ? evaluate_masses(arguments, **taxonomy) : evaluate_models(arguments, **taxonomy);
}

}  // namespace embody::cli
