// SPDX-License-Identifier: MIT
#include "attributes/classify.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "attributes/phrase_match.h"
#include "attributes/physical_kind.h"
#include "cli/commands.h"
#include "cli/locations.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using attributes::AttributeEntry;
using attributes::AttributeSet;
using attributes::Candidate;
using attributes::Classification;

attributes::ModelFacts facts_of(const ClassifyArguments& arguments) {
    attributes::ModelFacts facts;
    facts.name = arguments.name;
    facts.tags = arguments.tags;
    facts.catalogue_category = arguments.category;
    facts.folder = arguments.folder;
    if (arguments.size.size() == 3) {
        facts.geometry.size = {arguments.size[0], arguments.size[1], arguments.size[2]};
        facts.size_is_stated = true;
    }
    return facts;
}

// The senses of the name in WordNet, the most common first, each with the three hypernyms above it: "crane.n.04 >
// lifting_device.n.01 > …". Empty where WordNet does not have the name.
std::vector<std::string> senses_of(const attributes::Taxonomy::Data& data, std::string_view name) {
    std::string words = attributes::stems_of(name);
    std::ranges::replace(words, ' ', '_');
    const auto lemma = data.nouns->find_inflected(words);
    std::vector<std::string> senses;
    if (!lemma) return senses;
    for (const attributes::wordnet::NounSense& sense : data.nouns->senses(*lemma)) {
        std::string text = data.nouns->name(sense.synset);
        auto current = sense.synset;
        for (int up = 0; up < 3 && !data.nouns->hypernyms(current).empty(); ++up) {
            current = data.nouns->hypernyms(current).front();
            text += " > " + data.nouns->name(current);
        }
        senses.push_back(std::move(text));
    }
    return senses;
}

// The unit, in metres, in which the model would have the usual size of its category, where metres do not fit.
std::optional<double> unit_that_fits(const attributes::Taxonomy& taxonomy, attributes::ModelFacts facts) {
    facts.size_is_stated = false;
    return attributes::suggested_scale(taxonomy, facts);
}

nlohmann::json to_json(const Candidate& candidate) {
    nlohmann::json row = {{"category", candidate.category->name},
                          {"confidence", candidate.confidence},
                          {"level", attributes::level_name(candidate.level)},
                          {"steps", candidate.steps},
                          {"source", candidate.source}};
    if (!candidate.category->parent.empty()) row["category_above"] = candidate.category->parent;
    if (!candidate.synset.empty()) row["synset"] = candidate.synset;
    return row;
}

void print(const Classification& what, const AttributeSet& set, std::optional<double> unit,
           const std::vector<std::string>& senses) {
    const auto line = [](const char* label, const std::string& text) {
        if (!text.empty()) print_text("  {} {}\n", padded(label, 11), text);
    };
    const std::string above = what.category->parent.empty() ? "" : ", a kind of " + what.category->parent;
    print_text("{}{}  (confidence {:.2f})\n", what.category->name, above, what.confidence);
    line("because", what.source);
    line("reckoned", what.reckoning);
    line("meaning", what.synset);
    line("kind", to_text(kind_of(set)) + ", " + set.word("surface_material", ""));
    if (const AttributeEntry* mass = set.find("mass"); mass != nullptr && mass->low && mass->high) {
        line("mass", fmt::format("{:.3g} kg [{:.3g} … {:.3g}]", set.number("mass", 0), *mass->low, *mass->high));
    }
    if (unit)
        line("size", fmt::format("is unusual for {}; it would fit in units of {:g} m", what.category->name, *unit));
    for (const Candidate& other : what.others) {
        line("or", fmt::format("{} ({:.2f}): {}", other.category->name, other.confidence, other.source));
    }
    for (const std::string& sense : senses) line("sense", sense);
}

}  // namespace

int run_classify(const ClassifyArguments& arguments) {
    const auto taxonomy =
        attributes::Taxonomy::load(data_folder() / "taxonomy", catalog::Catalog::user_taxonomy_folder());
    if (!taxonomy) return report(taxonomy.error());
    const attributes::ModelFacts facts = facts_of(arguments);
    const Classification what = attributes::classify((*taxonomy)->data(), facts);
    const AttributeSet set = attributes::resolve(**taxonomy, facts);
    const std::vector<std::string> senses = senses_of((*taxonomy)->data(), arguments.name);
    const std::optional<double> unit = unit_that_fits(**taxonomy, facts);
    if (!arguments.json) {
        print(what, set, unit, senses);
        return exit_ok;
    }
    nlohmann::json answer = to_json(what);
    answer["reckoning"] = what.reckoning;
    answer["kind"] = to_text(kind_of(set));
    answer["material"] = set.word("surface_material", "");
    if (const AttributeEntry* mass = set.find("mass"); mass != nullptr && mass->low && mass->high) {
        answer["mass_kg"] = {{"value", set.number("mass", 0)}, {"low", *mass->low}, {"high", *mass->high}};
    }
    if (unit) answer["unit_that_fits_m"] = *unit;
    answer["senses"] = senses;
    answer["candidates"] = nlohmann::json::array();
    for (const Candidate& other : what.others) answer["candidates"].push_back(to_json(other));
    print_json(answer);
    return exit_ok;
}

}  // namespace embody::cli
