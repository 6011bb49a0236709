// SPDX-License-Identifier: MIT
#include "attributes/as_model.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "attributes/words.h"

namespace embody::attributes {
namespace {

// Stems of words that say that the substance itself is meant, in bulk or flowing.
constexpr std::array<std::string_view, 22> bulk_words{
    "blob", "drop", "droplet", "fluid",  "heap",  "layer",   "liquid", "loose",  "melted", "molten", "mound",
    "pile", "pool", "poured",  "puddle", "spill", "spilled", "spilt",  "splash", "stain",  "stream", "surface"};

bool says_bulk(std::string_view name) {
    return std::ranges::any_of(tokens_of(name), [](const Token& token) {
        return std::ranges::find(bulk_words, token.stem) != bulk_words.end();
    });
}

bool is_model(const ModelFacts& facts) {
    return facts.size_is_stated || largest_extent(facts) > 0 || facts.geometry.volume > 0;
}

}  // namespace

Classification as_model(const Taxonomy::Data& data, const ModelFacts& facts, Classification what) {
    const CategoryData& substance = *what.category;
    if (!substance.model_entry || !is_model(facts) || says_bulk(facts.name)) return what;
    const CategoryData& model = data.categories[*substance.model_entry];
    constexpr double far_beyond = 4;
    if (facts.size_is_stated && largest_extent(facts) > far_beyond * model.usual_high) return what;

    what.category = &model;
    what.source += "; a model of " + substance.name + " is usually \"" + model.name + "\"";
    what.reckoning += ", taken for what a model of it shows";
    what.level = model.parent.empty() ? AttributeLevel::category : AttributeLevel::subcategory;
    return what;
}

}  // namespace embody::attributes
