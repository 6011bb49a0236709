// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "attributes/model_facts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// One answer to what a model is.
struct Candidate {
    const CategoryData* category = nullptr;  ///< never null
    double confidence = 0;  ///< 0 to 1: probability that the thing is of the category or of one above it
    std::string where;   ///< the source: "collection", "name", "tag", "folder", "catalogue category", "part material";
                         ///< empty: none
    std::string source;  ///< "name says "tureen" → tureen.n.01 → bowl.n.01 (1 step up)"
    std::string phrase;  ///< the words that decided; empty where none did
    std::string synset;  ///< what these words mean in WordNet; empty where unknown
    std::size_t steps = 0;                            ///< hypernyms from that meaning up to the category
    std::string reckoning;                            ///< how the confidence was computed
    AttributeLevel level = AttributeLevel::standard;  ///< subcategory, category, or standard if unknown
};

/// What a model is, and why we think so.
struct Classification : Candidate {
    std::vector<Candidate> others;  ///< what else it could be, the likeliest first
};

/// The answer comes from a collection's description of the thing, or from the name where the name is more exact.
/// Without a description it comes from the name, else the tags, the folder, the catalogue's category, the names of the
/// parts' materials; in each the taxonomy's own phrases first, then the nearest category above a noun that WordNet
/// knows. The source names a runner-up that is close. A model of a substance is often something else (of beer, its
/// bottle): see as_model.h.
Classification classify(const Taxonomy::Data& data, const ModelFacts& facts);

/// Standard deviation of ln(mass) that this number of hypernyms adds to the category's own.
double spread_of_steps(std::size_t steps);

struct MaterialChoice {
    const MaterialData* material = nullptr;  ///< never null
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// The material that the name says ("wooden desk"), else the parts' material names, else the category.
MaterialChoice choose_material(const Taxonomy::Data& data, const ModelFacts& facts, const Classification& what);

/// The material that the name of a part's material says; null where it says none.
const MaterialData* material_of_part(const Taxonomy::Data& data, const std::string& part);

}  // namespace embody::attributes
