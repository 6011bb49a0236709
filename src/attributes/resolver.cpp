// SPDX-License-Identifier: MIT
// The paper's mapping (Fig. 4): words → category → physical kind → attribute set; then attributes from the geometry.
#include "attributes/resolver.h"

#include <algorithm>
#include <cmath>

#include "attributes/assemble.h"
#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/mass_estimate.h"
#include "attributes/material_parts.h"
#include "attributes/phrase_match.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"

namespace embody::attributes {
namespace {

constexpr double max_density = 22600;  // osmium, kg/m³

// "usual for chair", with the user's file where it says so.
std::string usual_for(const CategoryData& category, const char* field) {
    const auto file = category.set_by_file.find(field);
    return "usual for " + category.name + (file != category.set_by_file.end() ? ", says your " + file->second : "");
}

void put_identity(AttributeSet& set, const ModelFacts& facts, const Classification& what) {
    const CategoryData& category = *what.category;
    const bool is_sub = !category.parent.empty();
    const auto word = [&](const char* name, const std::string& value, const std::string& source, AttributeLevel level) {
        set.put({name, value, {}, {}, source, level});
    };
    word("category", is_sub ? category.parent : category.name, what.source, what.level);
    if (is_sub) word("subcategory", category.name, what.source, what.level);
    const std::string named = what.synset == category.synset ? category.name : "\"" + what.phrase + "\"";
    if (!what.synset.empty()) word("synset", what.synset, "meaning of " + named, what.level);
    set.put({"category_confidence", what.confidence, {}, {}, what.reckoning, what.level});
    word("placement", category.placement, usual_for(category, "placement"), what.level);

    const auto kind = [&](PhysicalKind of_it, const std::string& source, AttributeLevel level) {
        set.put({"kind", to_value(of_it), {}, {}, source, level});
    };
    // Whether it moves: the catalogue's flags decide before the category.
    if (facts.door_or_window) {
        kind(PhysicalKind::static_body, "the catalogue says that it is a door or window", AttributeLevel::model);
    } else if (facts.movable) {
        const std::string verdict = *facts.movable ? "the catalogue says movable" : "the catalogue says not movable";
        const bool agrees = *facts.movable == category.movable;
        kind(*facts.movable ? category.kind : PhysicalKind::static_body,
             verdict + (agrees ? ", as usual for " : ", unlike what is usual for ") + category.name,
             AttributeLevel::model);
    } else {
        kind(category.movable ? category.kind : PhysicalKind::static_body,
             usual_for(category, category.set_by_file.contains("movable") ? "movable" : "kind"), what.level);
    }
}

// A length far outside the usual size is a sign of a wrong unit: the source says so, and the person or the importer
// corrects it.
void put_scale(AttributeSet& set, const ModelFacts& facts, const CategoryData& category, const Form& form) {
    std::string source = facts.size_is_stated ? "size stated by the catalogue" : "file taken to be in metres";
    const double largest = std::max({form.size.x, form.size.y, form.size.z});
    const bool usual = largest >= category.usual_low / 2 && largest <= category.usual_high * 2;
    if (form.size_known && !usual) {
        source += "; largest side " + short_number(largest) + " m is unusual for " + category.name + " (" +
                  short_number(category.usual_low) + " to " + short_number(category.usual_high) + " m)";
        if (const auto factor = likely_unit(largest, category.usual_low, category.usual_high);
            factor && !facts.size_is_stated) {
            source += "; it would fit at " + short_number(*factor) + " m a unit";
        }
    }
    set.put({"scale_to_m", 1.0, {}, {}, source, AttributeLevel::model});
}

void put_mass(AttributeSet& set, const MassEstimate& estimate, const Substance& substance, const Form& form) {
    // The mass is clamped to the registry's range and to the density of the densest element.
    const AttributeDescription& range = *describe("mass");
    const double max_mass = std::min(*range.high, max_density * form.volume);
    const auto possible = [&](double mass) { return std::clamp(mass, std::min(*range.low, max_mass), max_mass); };
    const Interval mass{possible(estimate.mass.low), possible(estimate.mass.typical), possible(estimate.mass.high)};
    set.put({"mass", mass.typical, mass.low, mass.high, estimate.source, estimate.level});
    set.put({"volume", form.volume, {}, {}, form.volume_source, form.volume_level});

    // Mass = density × fill × volume: the materials set the density, and the fill follows, at most 1.
    const Interval& density = substance.density;
    const double fill = mass.typical / (density.typical * form.volume);
    if (fill <= 1) {
        set.put({"density", density.typical, density.low, density.high, substance.source, substance.level});
        set.put({"fill_fraction", fill, {}, {}, "mass / (density x volume)", AttributeLevel::model});
    } else {
        set.put({"density",
                 std::min(mass.typical / form.volume, max_density),
                 {},
                 {},
                 "mass / volume: " + substance.name + " would be too light for it",
                 AttributeLevel::model});
        set.put({"fill_fraction", 1.0, {}, {}, "full", AttributeLevel::model});
    }
}

void put_form(AttributeSet& set, const ModelFacts& facts, const std::vector<MaterialPart>& parts, const Form& form) {
    const double mass = set.number("mass", 1);
    const CenterAndInertia moments = center_and_inertia(facts.geometry, form, mass, spread_over(parts, mass));
    set.put({"center_of_mass", moments.center, {}, {}, moments.source, moments.level});
    set.put({"inertia", moments.inertia, {}, {}, moments.source, moments.level});
    const ShapeChoice shape = choose_collision_shape(facts.geometry, is_static(kind_of(set)));
    set.put({"collision_shape", shape.shape, {}, {}, shape.source, shape.level});
}

// The category's values other than mass and material, where they concern the final kind.
void put_category_attributes(AttributeSet& set, const Classification& what) {
    const PhysicalKind kind = kind_of(set);
    for (const CategoryAttribute& usual : what.category->attributes) {
        if (!applies_to(usual.name, kind)) continue;
        replace(set, {usual.name, usual.value.typical, usual.value.low, usual.value.high,
                      what.category->name + ": " + usual.source, what.level});
    }
}

}  // namespace

std::optional<double> likely_unit(double largest, double usual_low, double usual_high) {
    // Millimetre, centimetre, inch, foot, decimetre; then files that hold metres where they claim a smaller unit.
    for (const double factor : {0.001, 0.01, 0.0254, 0.3048, 0.1, 1000.0, 100.0, 10.0}) {
        if (largest * factor >= usual_low && largest * factor <= usual_high) return factor;
    }
    return std::nullopt;
}

std::optional<double> suggested_scale(const Taxonomy& taxonomy, const ModelFacts& facts) {
    const CategoryData& category = *classify(taxonomy.data(), facts).category;
    const Vec3 size = facts.geometry.size;
    const double largest = std::max({size.x, size.y, size.z});
    const bool usual = largest >= category.usual_low / 2 && largest <= category.usual_high * 2;
    if (facts.size_is_stated || usual || !is_finite(size)) return std::nullopt;
    return likely_unit(largest, category.usual_low, category.usual_high);
}

std::optional<double> density_sum(const Taxonomy& taxonomy, const ModelFacts& facts) {
    const Taxonomy::Data& data = taxonomy.data();
    const Classification what = classify(data, facts);
    const auto parts = material_parts(data, facts, *what.category, choose_material(data, facts, what));
    if (parts.empty()) return std::nullopt;
    return mass_of_parts(parts);
}

namespace {

AttributeSet resolve_as(const Taxonomy::Data& data, const ModelFacts& facts, Classification what) {
    if (const auto file = data.user_words.find(stems_of(what.phrase)); file != data.user_words.end()) {
        what.source += ", a word of your " + file->second;
    }
    const MaterialChoice surface = choose_material(data, facts, what);
    AttributeSet set;
    put_identity(set, facts, what);
    put_surface(set, *surface.material, surface.source, surface.level);

    // The form determines the mass and its distribution.
    const Form form = form_of(facts.geometry, what.category->at_size);
    put_scale(set, facts, *what.category, form);
    const std::vector<MaterialPart> parts = material_parts(data, facts, *what.category, surface);
    const Substance substance = substance_of(parts, surface);
    put_mass(set, estimate_mass(data, what, substance, form, facts.geometry.closed), substance, form);
    put_mass_dependents(set, facts.geometry, form);
    put_form(set, facts, parts, form);
    put_category_attributes(set, what);

    // Defaults for the attributes that are still missing.
    complete_for_kind(set);
    put_resolution(set, facts.geometry, form);
    return set;
}

// The entry of this name, else the entry that has the word.
const CategoryData* category_called(const Taxonomy::Data& data, std::string_view word) {
    if (const CategoryData* category = data.category(word)) return category;
    const auto phrase = data.category_phrases.find(stems_of(word));
    return phrase == data.category_phrases.end() ? nullptr : &data.categories[phrase->second.entry];
}

}  // namespace

AttributeSet resolve(const Taxonomy& taxonomy, const ModelFacts& facts) {
    return resolve_as(taxonomy.data(), facts, classify(taxonomy.data(), facts));
}

std::optional<AttributeSet> resolve_primitive(const Taxonomy& taxonomy, std::string_view category,
                                              const ModelFacts& facts) {
    const Taxonomy::Data& data = taxonomy.data();
    const CategoryData* known = category_called(data, category);
    if (known == nullptr || !known->movable || !changes_form(known->kind)) return std::nullopt;
    Classification what;
    what.category = known;
    what.confidence = 1;
    what.where = "category";
    what.source = "the entity's category \"" + std::string(category) + "\"";
    what.phrase = category;
    what.synset = known->synset;
    what.reckoning = "a person named it";
    what.level = known->parent.empty() ? AttributeLevel::category : AttributeLevel::subcategory;
    AttributeSet set = resolve_as(data, facts, std::move(what));

    // The form of a primitive is exact; its moments are those of the whole shape, wherever its origin is.
    const GeometryFacts& form = facts.geometry;
    if (form.volume > 0) {
        const double mass = set.number("mass", 1);
        replace(set, {"center_of_mass", form.center_of_volume, {}, {}, "homogeneous", AttributeLevel::measured});
        replace(set, {"inertia",
                      form.unit_inertia * (mass / form.volume),
                      {},
                      {},
                      "homogeneous, of this mass",
                      AttributeLevel::measured});
    }
    set.erase("collision_shape");
    return set;
}

}  // namespace embody::attributes
