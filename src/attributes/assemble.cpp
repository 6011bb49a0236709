// SPDX-License-Identifier: MIT
#include "attributes/assemble.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "attributes/registry.h"

namespace embody::attributes {
namespace {

double within(const char* name, double value) {
    const AttributeDescription& description = *describe(name);
    if (description.low) value = std::max(value, *description.low);
    if (description.high) value = std::min(value, *description.high);
    return value;
}

void put_number(AttributeSet& set, const char* name, double value, std::string source, AttributeLevel level) {
    replace(set, {name, within(name, value), {}, {}, std::move(source), level});
}

}  // namespace

bool applies_to(std::string_view attribute, PhysicalKind kind) {
    const AttributeDescription* description = describe(attribute);
    return description != nullptr && applies_to(*description, kind);
}

namespace {

// A round rod of one material has GJ / EI = 1 / (1 + ν). Used where the twist rigidity is unknown, or where a person
// set only the bend rigidity.
void put_twist_rigidity(AttributeSet& set) {
    constexpr double poisson_ratio = 0.3;
    const AttributeEntry* held = set.find("twist_rigidity");
    if (held == nullptr || (held->level != AttributeLevel::standard && !is_manual(set, "bend_rigidity"))) return;
    const AttributeDescription& range = *describe("twist_rigidity");
    const double rigidity = set.number("bend_rigidity", 1e-3) / (1 + poisson_ratio);
    replace(set, {"twist_rigidity",
                  std::clamp(rigidity, *range.low, *range.high),
                  {},
                  {},
                  "bend rigidity / (1 + Poisson's ratio of 0.3), as of a round rod",
                  AttributeLevel::model});
}

}  // namespace

void complete_for_kind(AttributeSet& set) {
    const PhysicalKind kind = kind_of(set);
    for (const AttributeDescription& description : registry()) {
        const AttributeEntry* held = set.find(description.name);
        const bool concerns = applies_to(description, kind);
        if (held != nullptr && !concerns && held->level != AttributeLevel::manual) set.erase(description.name);
        if (held == nullptr && concerns) {
            set.put({description.name, description.standard, {}, {}, "default", AttributeLevel::standard});
        }
    }
    if (traits_of(kind).matter == Matter::line) put_twist_rigidity(set);
}

bool is_manual(const AttributeSet& set, std::string_view name) {
    const AttributeEntry* held = set.find(name);
    return held != nullptr && held->level == AttributeLevel::manual;
}

void replace(AttributeSet& set, AttributeEntry entry) {
    if (is_manual(set, entry.name)) return;
    set.erase(entry.name);
    set.put(std::move(entry));
}

void put_surface(AttributeSet& set, const MaterialData& material, const std::string& source, AttributeLevel level) {
    const std::string why = material.name + " (" + source + "): " + material.source;
    const auto interval = [&](const char* name, const Interval& i) {
        replace(set, {name, i.typical, i.low, i.high, why, level});
    };
    replace(set, {"surface_material", material.name, {}, {}, source, level});
    interval("friction_static", material.friction_static);
    interval("friction_dynamic", material.friction_dynamic);
    interval("restitution", material.restitution);
    replace(set, {"friction_rolling", material.friction_rolling, {}, {}, why, level});
}

void put_mass_dependents(AttributeSet& set, const GeometryFacts& facts, const Form& form) {
    const double mass = set.number("mass", 1);
    const double density = set.number("density", 1000);
    const double fill = set.number("fill_fraction", 1);
    const double volume = set.number("volume", form.volume);
    const AttributeLevel level = AttributeLevel::model;
    put_number(set, "bulk_density", mass / form.box_volume, "mass / volume of the bounding box", level);

    // Wall thickness of a hollow thing: material volume over the area of its surface.
    if (facts.surface_area > 0 && fill < 0.9) {
        put_number(set, "wall_thickness", fill * volume / facts.surface_area, "material volume / surface area", level);
    }
    // Mean projected area of a convex body is a quarter of its surface (Cauchy).
    const Vec3 s = form.size;
    put_number(set, "drag_area", (s.x * s.y + s.y * s.z + s.z * s.x) / 2, "mean projected area of the bounding box",
               level);

    const char* by_material = "density of the material";
    switch (matter_of(set)) {
        case Matter::none:
        case Matter::body:
        case Matter::solid:
            return;
        case Matter::sheet:
            return put_number(set, "area_density", mass / form.face_area, "mass / largest face of the box", level);
        case Matter::line:
            return put_number(set, "linear_density", mass / std::max({s.x, s.y, s.z}), "mass / largest extent", level);
        case Matter::liquid:
            return put_number(set, "rest_density", density, by_material, level);
        case Matter::grains:
            return put_number(set, "grain_density", density, by_material, level);
    }
}

namespace {

// Three digits are enough for a count in the thousands.
std::string counted(double count) {
    const double step = std::pow(10, std::max(0.0, std::floor(std::log10(count)) - 2));
    return std::to_string(std::llround(count / step) * std::llround(step));
}

void put_simulated_grains(AttributeSet& set, double volume, const Form& form) {
    const double grain = set.number("grain_diameter", 0.002), budget = set.number("grain_budget", 2000);
    const double min_diameter = std::cbrt(6 * loose_packing * volume / (std::numbers::pi * budget));
    const AttributeDescription& range = *describe("simulated_diameter");
    // At least one layer of grains must fit inside.
    const double largest = std::max(*range.low, 0.6 * std::min({form.size.x, form.size.y, form.size.z}));
    const double diameter = std::min(std::max({grain, min_diameter, *range.low}), largest);
    const double stands_for = std::pow(diameter / grain, 3);
    const std::string source = stands_for < 1.5 ? "of a grain"
                                                : "each ball stands for " + counted(stands_for) + " grains, so that " +
                                                      counted(budget) + " fill its volume of " +
                                                      short_number(volume * 1000) + " litres";
    put_number(set, "simulated_diameter", diameter, source, AttributeLevel::model);
}

// A cell has eight particles.
void put_fluid_cells(AttributeSet& set, double volume) {
    // A step in which the liquid crosses several cells is cut into as many parts, so that small cells cost more than
    // their number says. Below this size the cells are only as small as a thousand particles need.
    constexpr double usual_cell = 0.006, min_particles = 1000;
    const double budget = set.number("particle_budget", 20000);
    const auto cell_for = [volume](double particles) { return std::cbrt(8 * volume / particles); };
    const double by_budget = cell_for(budget);
    const double cell = std::max(by_budget, std::min(usual_cell, cell_for(std::min(min_particles, budget))));
    const std::string source = counted(8 * volume / (cell * cell * cell)) + " particles, eight in a cell, fill its " +
                               "volume of " + short_number(volume * 1000) + " litres" +
                               (cell > by_budget ? "; smaller cells would take many parts of a step" : "");
    put_number(set, "fluid_cell_size", cell, source, AttributeLevel::model);
}

}  // namespace

void put_resolution(AttributeSet& set, const GeometryFacts& facts, const Form& form) {
    const double volume = facts.hull_volume > 0 && std::isfinite(facts.hull_volume) ? facts.hull_volume : form.volume;
    switch (matter_of(set)) {
        case Matter::none:
        case Matter::body:
        case Matter::solid:
        case Matter::sheet:
        case Matter::line:
            return;
        case Matter::liquid:
            return put_fluid_cells(set, volume);
        case Matter::grains:
            return put_simulated_grains(set, volume, form);
    }
}

namespace {

// Mass by area: a box as thin as cloth, but solid, would be far too heavy.
void put_mass_of_sheet(AttributeSet& set, const GeometryFacts& facts) {
    const Vec3 size = facts.size;
    const double thickness = std::min({size.x, size.y, size.z});
    // Triangles have no volume: their area is the largest face of their box. A plane has no area at all.
    const bool is_solid = facts.volume > 0 && thickness > 0;
    const double face = std::max({size.x * size.y, size.y * size.z, size.z * size.x});
    const double area = is_solid ? facts.volume / thickness : face;
    if (!(area > 0)) return;
    if (is_solid) put_number(set, "thickness", thickness, "thickness of the shape", AttributeLevel::measured);
    if (is_manual(set, "mass")) {
        put_number(set, "area_density", set.number("mass", 1) / area, "manual mass / area", AttributeLevel::model);
        return;
    }
    const double usual = std::get<double>(describe("area_density")->standard);
    const AttributeEntry* held = set.find("area_density");
    if (held == nullptr || held->level == AttributeLevel::model)
        put_number(set, "area_density", usual, "default", AttributeLevel::standard);
    put_number(set, "mass", set.number("area_density", usual) * area, "area density × area of the sheet",
               AttributeLevel::model);
}

// Mass: linear density of the category times length. Without a density of the category the mass stays that of a solid.
void put_mass_of_line(AttributeSet& set, const GeometryFacts& facts) {
    const AttributeEntry* held = set.find("linear_density");
    const double along = std::max({facts.size.x, facts.size.y, facts.size.z});
    const bool says =
        held != nullptr && (held->level == AttributeLevel::category || held->level == AttributeLevel::subcategory);
    if (!says || !(along > 0)) return;
    put_number(set, "mass", set.number("linear_density", 0) * along, "linear density × length", AttributeLevel::model);
}

void put_mass_by_volume(AttributeSet& set, double density, double volume, const char* source) {
    if (volume > 0) put_number(set, "mass", density * volume, source, AttributeLevel::model);
}

}  // namespace

void put_mass_of_primitive(AttributeSet& set, const GeometryFacts& facts) {
    switch (matter_of(set)) {
        case Matter::none:
        case Matter::body:
        case Matter::solid:
            return;
        case Matter::sheet:
            return put_mass_of_sheet(set, facts);
        case Matter::line:
            return put_mass_of_line(set, facts);
        case Matter::liquid:
            return put_mass_by_volume(set, set.number("rest_density", 998), facts.volume, "rest density × volume");
        case Matter::grains:
            return put_mass_by_volume(set, set.number("grain_density", 2650) * loose_packing, facts.volume,
                                      "grain density × 0.55, as poured grains lie, × volume");
    }
}

}  // namespace embody::attributes
