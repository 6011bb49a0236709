// SPDX-License-Identifier: MIT
// Values that a person set stay; values that follow from them are computed again.
#include <algorithm>

#include "attributes/assemble.h"
#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/resolver.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

bool in_range(const char* name, double value) { return validate(name, value).ok(); }

void put_derived(AttributeSet& set, const char* name, AttributeValue value, std::string source) {
    replace(set, {name, std::move(value), {}, {}, std::move(source), AttributeLevel::model});
}

// A given mass sets the density; it sets the fill where the density is given too or would be impossible.
void explain_mass(AttributeSet& set) {
    const double mass = set.number("mass", 1);
    const double volume = set.number("volume", 1);
    const double fill = set.number("fill_fraction", 1);
    const double density = set.number("density", 1000);
    const double needed_density = mass / (fill * volume);
    if (!is_manual(set, "density") && in_range("density", needed_density)) {
        put_derived(set, "density", needed_density, "manual mass / (fill x volume)");
        return;
    }
    const double needed_fill = mass / (density * volume);
    if (!is_manual(set, "fill_fraction") && in_range("fill_fraction", needed_fill)) {
        put_derived(set, "fill_fraction", needed_fill, "manual mass / (density x volume)");
        return;
    }
    // Density or fill alone cannot hold the mass: the fill becomes 1 and the density follows.
    const double full_density = mass / volume;
    if (!is_manual(set, "density") && !is_manual(set, "fill_fraction") && in_range("density", full_density)) {
        put_derived(set, "fill_fraction", 1.0, "full, to hold the manual mass");
        put_derived(set, "density", full_density, "manual mass / volume");
    }
}

// Mass of cloth by its area, of a rope by its length.
bool spread_mass(AttributeSet& set, const Form& form) {
    const bool is_sheet = matter_of(set) == Matter::sheet;
    const char* name = is_sheet ? "area_density" : "linear_density";
    if (!is_manual(set, name)) return false;
    const double amount = is_sheet ? form.face_area : std::max({form.size.x, form.size.y, form.size.z});
    const AttributeDescription& range = *describe("mass");
    put_derived(set, "mass", std::clamp(set.number(name, 1) * amount, *range.low, *range.high),
                is_sheet ? "manual area density x largest face of the box" : "manual linear density x largest extent");
    return true;
}

void update_mass(AttributeSet& set, const Form& form) {
    if (is_manual(set, "mass")) return explain_mass(set);
    if (spread_mass(set, form)) return;
    if (is_manual(set, "bulk_density")) {
        put_derived(set, "mass", set.number("bulk_density", 1) * form.box_volume, "manual bulk density x bounding box");
        return explain_mass(set);
    }
    for (const char* name : {"density", "fill_fraction", "volume"}) {
        if (!is_manual(set, name)) continue;
        const double mass = set.number("density", 1000) * set.number("fill_fraction", 1) * set.number("volume", 1);
        const AttributeDescription& range = *describe("mass");
        put_derived(set, "mass", std::clamp(mass, *range.low, *range.high),
                    std::string("density x fill x volume, with manual ") + name);
        return;
    }
}

// Inertia of the same mass distribution at another mass.
void scale_inertia(AttributeSet& set, double mass_before) {
    const double mass = set.number("mass", mass_before);
    const AttributeEntry* held = set.find("inertia");
    if (held == nullptr || mass == mass_before || is_manual(set, "inertia")) return;
    const Mat3 inertia = std::get<Mat3>(held->value) * (mass / mass_before);
    put_derived(set, "inertia", inertia, held->source + ", scaled to a mass of " + short_number(mass) + " kg");
}

// Sliding friction is never above static friction: the one that nobody set is changed.
void order_friction(AttributeSet& set) {
    const double at_rest = set.number("friction_static", 0);
    const double sliding = set.number("friction_dynamic", 0);
    if (sliding <= at_rest) return;
    if (is_manual(set, "friction_static")) {
        put_derived(set, "friction_dynamic", at_rest, "lowered to the manual static friction");
    } else {
        put_derived(set, "friction_static", sliding, "raised to the manual sliding friction");
    }
}

// Only static things collide with their triangles, and static things always do.
void update_collision_shape(AttributeSet& set, const GeometryFacts& facts, PhysicalKind kind_before) {
    const PhysicalKind kind = kind_of(set);
    if (kind == kind_before || set.find("collision_shape") == nullptr) return;
    const ShapeChoice choice = choose_collision_shape(facts, is_static(kind));
    replace(set, {"collision_shape", choice.shape, {}, {}, choice.source, choice.level});
}

// Takes valid entries only, each at level `manual`, whatever its own level was.
AttributeSet override_by(const AttributeSet& automatic, const std::vector<AttributeEntry>& manual) {
    AttributeSet set = automatic;
    for (AttributeEntry entry : manual) {
        if (!validate(entry.name, entry.value)) continue;
        entry.level = AttributeLevel::manual;
        if (entry.source.empty()) entry.source = "set by a person";
        set.put(std::move(entry));
    }
    return set;
}

// A person's material brings its density; the amount of material stays.
void update_material(AttributeSet& set, const Taxonomy& taxonomy) {
    if (!is_manual(set, "surface_material")) return;
    AttributeEntry named = *set.find("surface_material");
    auto known = known_value(taxonomy, named.name, std::move(named.value));
    if (!known) return;
    named.value = std::move(*known);
    set.put(std::move(named));
    const MaterialData* material = taxonomy.data().material(set.word("surface_material", ""));
    const double mass_per_density = set.number("mass", 1) / set.number("density", 1000);
    put_surface(set, *material, "manual surface material", AttributeLevel::model);
    if (is_manual(set, "mass") || is_manual(set, "density") || is_manual(set, "bulk_density")) return;
    const Interval& density = material->density;
    const AttributeDescription& range = *describe("mass");
    replace(set, {"density", density.typical, density.low, density.high, "manual surface material: " + material->source,
                  AttributeLevel::model});
    put_derived(set, "mass", std::clamp(density.typical * mass_per_density, *range.low, *range.high),
                "the same amount of material, in " + material->name);
}

AttributeSet with_manual(const Taxonomy* taxonomy, const AttributeSet& automatic,
                         const std::vector<AttributeEntry>& manual, const ModelFacts& facts) {
    AttributeSet set = override_by(automatic, manual);
    complete_for_kind(set);
    const Form form = form_of(facts.geometry, {0.5, 0.5, 0.5});
    const double mass_before = automatic.number("mass", set.number("mass", 1));
    const PhysicalKind kind_before = kind_of(automatic);

    // Causes first: material, mass, then attributes that depend on the mass.
    if (taxonomy != nullptr) update_material(set, *taxonomy);
    update_mass(set, form);
    scale_inertia(set, mass_before);
    const PhysicalKind kind = kind_of(set);
    const bool is_now_thin = kind != kind_before && is_thin(kind);
    if (set.number("mass", mass_before) != mass_before || is_now_thin) put_mass_dependents(set, facts.geometry, form);
    order_friction(set);
    update_collision_shape(set, facts.geometry, kind_before);
    complete_for_kind(set);
    put_resolution(set, facts.geometry, form);
    return set;
}

}  // namespace

Result<AttributeValue> known_value(const Taxonomy& taxonomy, std::string_view name, AttributeValue value) {
    const auto* word = name == "surface_material" ? std::get_if<std::string>(&value) : nullptr;
    if (word == nullptr || taxonomy.data().material(*word) != nullptr) return value;
    if (const MaterialData* meant = material_of_part(taxonomy.data(), *word)) return AttributeValue(meant->name);
    std::string names;
    for (const MaterialData& material : taxonomy.data().materials) {
        names += (names.empty() ? "" : ", ") + material.name;
    }
    return Error{std::string(name), "must be one of " + names + ", got \"" + *word + "\""};
}

AttributeSet with_manual(const AttributeSet& automatic, const std::vector<AttributeEntry>& manual,
                         const ModelFacts& facts) {
    return with_manual(nullptr, automatic, manual, facts);
}

AttributeSet with_manual(const Taxonomy& taxonomy, const AttributeSet& automatic,
                         const std::vector<AttributeEntry>& manual, const ModelFacts& facts) {
    return with_manual(&taxonomy, automatic, manual, facts);
}

}  // namespace embody::attributes
