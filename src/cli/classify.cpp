// SPDX-License-Identifier: MIT
#include "attributes/classify.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

void print(const Classification& what, const AttributeSet& set) {
    const auto line = [](const char* label, const std::string& text) {
        if (!text.empty()) fmt::print("  {} {}\n", padded(label, 11), text);
    };
    const std::string above = what.category->parent.empty() ? "" : ", a kind of " + what.category->parent;
    fmt::print("{}{}  (confidence {:.2f})\n", what.category->name, above, what.confidence);
    line("because", what.source);
    line("reckoned", what.reckoning);
    line("meaning", what.synset);
    line("kind", set.word("kind", "") + ", " + set.word("surface_material", ""));
    if (const AttributeEntry* mass = set.find("mass"); mass != nullptr && mass->low && mass->high) {
        line("mass", fmt::format("{} kg [{} … {}]", short_number(set.number("mass", 0)), short_number(*mass->low),
                                 short_number(*mass->high)));
    }
    for (const Candidate& other : what.others) {
        line("or", fmt::format("{} ({:.2f}): {}", other.category->name, other.confidence, other.source));
    }
}

}  // namespace

int run_classify(const ClassifyArguments& arguments) {
    const auto taxonomy = attributes::Taxonomy::load(data_folder() / "taxonomy");
    if (!taxonomy) return report(taxonomy.error());
    const attributes::ModelFacts facts = facts_of(arguments);
    const Classification what = attributes::classify((*taxonomy)->data(), facts);
    const AttributeSet set = attributes::resolve(**taxonomy, facts);
    if (!arguments.json) {
        print(what, set);
        return exit_ok;
    }
    nlohmann::json answer = to_json(what);
    answer["reckoning"] = what.reckoning;
    answer["kind"] = set.word("kind", "");
    answer["material"] = set.word("surface_material", "");
    if (const AttributeEntry* mass = set.find("mass"); mass != nullptr && mass->low && mass->high) {
        answer["mass_kg"] = {{"value", set.number("mass", 0)}, {"low", *mass->low}, {"high", *mass->high}};
    }
    answer["candidates"] = nlohmann::json::array();
    for (const Candidate& other : what.others) answer["candidates"].push_back(to_json(other));
    print_json(answer);
    return exit_ok;
}

}  // namespace embody::cli
