// SPDX-License-Identifier: MIT
#include "attributes/classify.h"

#include "attributes/phrase_match.h"

namespace embody::attributes {
namespace {

AttributeLevel level_of(const CategoryData& category) {
    return category.parent.empty() ? AttributeLevel::category : AttributeLevel::subcategory;
}

// "name says "lamp" (it also says "table")".
std::string because(std::string_view where, const PhraseMatch& match) {
    std::string text = std::string(where) + " says \"" + match.phrase + "\"";
    for (std::size_t i = 0; i < match.others.size() && i < 3; ++i) {
        text += (i == 0 ? "; it also says \"" : "\", \"") + match.others[i];
    }
    return match.others.empty() ? text : text + "\", which a name's last noun or first part overrules";
}

bool classify_by_words(const Taxonomy::Data& data, std::string_view where, std::string_view text,
                       Classification& result) {
    const auto match = match_phrase(data.category_phrases, data.longest_phrase, text);
    if (!match) return false;
    const CategoryData& category = data.categories[match->entry];
    result = {&category, because(where, *match), match->phrase, level_of(category)};
    return true;
}

bool classify_by_catalogue(const Taxonomy::Data& data, const std::string& name, Classification& result) {
    const auto found = data.by_catalogue.find(stems_of(name));
    if (found == data.by_catalogue.end()) return false;
    const CategoryData& category = data.categories[found->second];
    result = {&category, "the catalogue files it under \"" + name + "\"; no word of its name is known", "",
              level_of(category)};
    return true;
}

bool material_by_words(const Taxonomy::Data& data, const std::string& where, std::string_view text,
                       MaterialChoice& result) {
    // A "door with panes" is not made of glass: only the first part of a name says what it is made of.
    const auto match = match_phrase(data.material_phrases, data.longest_phrase, text);
    if (!match || match->segment > 0) return false;
    result = {&data.materials[match->entry], where + " says \"" + match->phrase + "\"", AttributeLevel::model};
    return true;
}

}  // namespace

Classification classify(const Taxonomy::Data& data, const ModelFacts& facts) {
    Classification result{&data.categories[data.unknown], "no word of its name, tags or folder is known", "",
                          AttributeLevel::standard};
    if (classify_by_words(data, "name", facts.name, result)) return result;
    for (const std::string& tag : facts.tags) {
        if (classify_by_words(data, "tag", tag, result)) return result;
    }
    if (classify_by_words(data, "folder", facts.folder, result)) return result;
    if (classify_by_catalogue(data, facts.catalogue_category, result)) return result;
    classify_by_words(data, "catalogue category", facts.catalogue_category, result);
    return result;
}

MaterialChoice choose_material(const Taxonomy::Data& data, const ModelFacts& facts, const Classification& what) {
    const MaterialData* usual = data.material(what.category->material);
    MaterialChoice result{usual, "usual for " + what.category->name, what.level};
    // The words that name the thing say nothing of its material: a "paper towel holder" is not made of paper.
    if (material_by_words(data, "name", without_phrase(facts.name, what.phrase), result)) return result;
    for (const std::string& part : facts.material_names) {
        if (material_by_words(data, "part material \"" + part.substr(0, 60) + "\"", part, result)) return result;
    }
    return result;
}

}  // namespace embody::attributes
