// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "attributes/model_facts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// What a model is, and why we think so.
struct Classification {
    const CategoryData* category = nullptr;  ///< never null
    std::string source;
    std::string phrase;                               ///< the words that decided; empty where none did
    AttributeLevel level = AttributeLevel::standard;  ///< subcategory, category, or standard where nothing tells
};

/// From the name, else the tags, else the folder, else the catalogue's category.
Classification classify(const Taxonomy::Data& data, const ModelFacts& facts);

struct MaterialChoice {
    const MaterialData* material = nullptr;  ///< never null
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// From the name ("wooden desk"), else the parts' material names, else the category.
MaterialChoice choose_material(const Taxonomy::Data& data, const ModelFacts& facts, const Classification& what);

}  // namespace embody::attributes
