// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "attributes/physical_kind.h"
#include "attributes/resolver.h"
#include "attributes/wordnet/noun_table.h"

namespace embody::attributes {

/// 80 % interval around a typical value.
struct Interval {
    double low = 0, typical = 0, high = 0;
};

/// A surface material of materials.json.
struct MaterialData {
    std::string name;
    std::vector<std::string> words;
    Interval density;          ///< kg/m³
    Interval friction_static;  ///< against the same or a common dry partner
    Interval friction_dynamic;
    double friction_rolling = 0;  ///< m
    Interval restitution;
    Interval wall;     ///< m, usual wall thickness of things made of it; all 0: solid throughout
    std::string core;  ///< the material inside things covered with it, such as foam; empty: they are hollow
    std::string source;
};

/// How the mass of a thing grows with its size.
enum class MassScaling { volume, area };

/// A number of the registry that is usual for a category.
struct CategoryAttribute {
    std::string name;
    Interval value;
    std::string source;
};

/// A category or subcategory of data/taxonomy/categories; a subcategory inherits the fields that it leaves out.
struct CategoryData {
    std::string name;
    std::string parent;  ///< of a subcategory: its category; else empty
    std::string domain;  ///< its file without ".json", such as "kitchen"
    std::string synset;  ///< its meaning in WordNet 3.0, such as "chair.n.01"; empty where WordNet has none
    std::vector<std::string> words;
    std::vector<std::string> catalogue;       ///< catalogue categories that mean this where no word says more
    PhysicalKind kind = PhysicalKind::rigid;  ///< its kind when movable; never static
    std::string placement;
    bool movable = true;
    Interval mass;  ///< kg, of a thing of at_size
    Vec3 at_size;   ///< extents of the box, m, in any order
    MassScaling scaling = MassScaling::volume;
    double exponent = 0.85;                ///< mass ∝ (box volume or area of the largest face)^exponent
    double usual_low = 0, usual_high = 0;  ///< of the largest extent, m
    bool solid = false;                    ///< the closed surface is filled to fill_fraction with the material
    Interval fill_fraction;                ///< used where solid
    std::string material;
    std::string source;                                           ///< of the numbers above
    std::map<std::string, std::string, std::less<>> set_by_file;  ///< field → the user's file that set it; else absent
    std::vector<CategoryAttribute> attributes;  ///< other usual values, such as the stiffness of a cushion
    std::string modelled_as;  ///< name of the entry that a model of it shows, for beer "beer bottle"; empty: itself
    std::optional<std::size_t> model_entry;  ///< index of that entry
};

/// ln of the factor by which this largest extent (m, positive) is outside the usual size; 0 within. Cloth and rope may
/// be folded, so that nothing is too small for them.
double outside_usual_size(const CategoryData& category, double largest);

/// A phrase that names an entry, e.g. "coffee table".
struct Phrase {
    std::string text;        ///< its words as written, joined by one space
    std::size_t length = 0;  ///< in words
    std::size_t entry = 0;   ///< index in Data::categories or Data::materials
};

/// Phrases by the stems of their words, joined by one space.
using PhraseIndex = std::multimap<std::string, Phrase, std::less<>>;

struct Taxonomy::Data {
    std::vector<MaterialData> materials;
    std::vector<CategoryData> categories;
    PhraseIndex category_phrases, material_phrases;
    std::map<std::string, std::size_t, std::less<>> by_catalogue;  ///< stems of the catalogue's category → index
    std::size_t unknown = 0;                                       ///< index of the category "object"
    std::map<std::string, std::string, std::less<>> user_words;    ///< stems → the user's file that added the word
    std::size_t longest_phrase = 1;
    std::shared_ptr<const wordnet::NounTable> nouns;                  ///< never null once loaded
    std::unordered_map<wordnet::SynsetIndex, std::size_t> by_synset;  ///< index of the entry that has this meaning

    [[nodiscard]] const MaterialData* material(std::string_view name) const;
    [[nodiscard]] const CategoryData* category(std::string_view name) const;
};

}  // namespace embody::attributes
