// SPDX-License-Identifier: MIT
//
// A part that encloses the volume V behind a surface A, of a material of density ρ whose walls are t thick:
//   wall volume  w = min(V, t A),  or t A of a sheet, which encloses nothing;
//   core volume  c = V - w,  of what fills the material where something does, else of air;
//   mass         m = ρ w + ρ_core c.
// Its moments lie between those of the surface as a thin shell and those of the solid: w/V of the wall's mass is spread
// as the solid, the rest as the shell (within 3 % of a hollow sphere's exact inertia at any thickness).
#include "attributes/material_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace embody::attributes {
namespace {

using geometry::MassProperties;

constexpr double sheet_of_solid = 0.005;  // m: thickness of a sheet of a material that has no usual wall
// Range of wall thickness relative to the usual one; a mass that it cannot reach is reached by scaling all densities
// alike.
constexpr double min_wall_factor = 0.05, max_wall_factor = 20;

struct Amount {
    double wall = 0, core = 0;  // m³
};

// Volumes of wall and core with walls `factor` times as thick as usual.
Amount amount_of(const MaterialPart& part, double factor) {
    const double volume = part.facts->form.solid.volume;
    if (!(volume > 0)) {
        const double thickness = part.usual_wall > 0 ? part.usual_wall : sheet_of_solid;
        return {factor * thickness * part.facts->form.shell.volume, 0};
    }
    if (!(part.usual_wall > 0)) return {volume, 0};
    const double wall = std::min(volume, factor * part.usual_wall * part.facts->form.shell.volume);
    return {wall, part.core != nullptr ? volume - wall : 0};
}

double mass_of(const MaterialPart& part, const Amount& amount) {
    const double core_density = part.core != nullptr ? part.core->density.typical : 0;
    return part.material->density.typical * amount.wall + core_density * amount.core;
}

double total_mass(const std::vector<MaterialPart>& parts, double factor) {
    double sum = 0;
    for (const MaterialPart& part : parts) sum += mass_of(part, amount_of(part, factor));
    return sum;
}

// Factor on the usual wall thickness at which the parts have this mass; the total mass grows with the factor.
double fitting_walls(const std::vector<MaterialPart>& parts, double mass) {
    if (total_mass(parts, min_wall_factor) >= mass) return min_wall_factor;
    if (total_mass(parts, max_wall_factor) <= mass) return max_wall_factor;
    double low = std::log(min_wall_factor), high = std::log(max_wall_factor);
    for (int halving = 0; halving < 50; ++halving) {
        const double middle = (low + high) / 2;
        (total_mass(parts, std::exp(middle)) < mass ? low : high) = middle;
    }
    return std::exp((low + high) / 2);
}

// The same distribution with the given mass: the field `volume` holds kg.
MassProperties of_mass(const MassProperties& measured, double mass) {
    return {mass, measured.center, (mass / measured.volume) * measured.inertia};
}

MassProperties spread(const MaterialPart& part, double factor) {
    const auto& [shell, solid] = part.facts->form;
    const Amount amount = amount_of(part, factor);
    const double wall_mass = part.material->density.typical * amount.wall;
    if (!(solid.volume > 0)) return of_mass(shell, wall_mass);
    const double filled = std::min(1.0, amount.wall / solid.volume);
    const double core_mass = mass_of(part, amount) - wall_mass;
    return geometry::combined(of_mass(shell, (1 - filled) * wall_mass), of_mass(solid, filled * wall_mass + core_mass));
}

// "steel 60 %, glass 40 %" of the mass, the heaviest first; at most three.
std::string fractions_text(const std::vector<MaterialPart>& parts, double factor) {
    std::vector<std::pair<const MaterialData*, double>> masses;
    const auto add = [&](const MaterialData* material, double volume) {
        const auto held = std::ranges::find(masses, material, &std::pair<const MaterialData*, double>::first);
        const double mass = material->density.typical * volume;
        if (held != masses.end()) {
            held->second += mass;
        } else if (mass > 0) {
            masses.emplace_back(material, mass);
        }
    };
    for (const MaterialPart& part : parts) {
        const Amount amount = amount_of(part, factor);
        add(part.material, amount.wall);
        if (part.core != nullptr) add(part.core, amount.core);
    }
    std::ranges::stable_sort(masses, std::greater{}, &std::pair<const MaterialData*, double>::second);
    const double total = total_mass(parts, factor);
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(masses.size(), 3); ++i) {
        text += (i > 0 ? ", " : "") + masses[i].first->name + " " + short_number(100 * masses[i].second / total) + " %";
    }
    return text + (masses.size() > 3 ? " …" : "");
}

// Facts may come from an old or foreign database.
bool can_be_real(const geometry::SolidAndShell& form) {
    constexpr double largest = 1e12;  // m² and m³
    return form.shell.volume > 0 && form.shell.volume < largest && std::fabs(form.solid.volume) < largest;
}

bool are_of_one_material(const std::vector<MaterialPart>& parts) {
    return std::ranges::all_of(
        parts, [&](const MaterialPart& p) { return p.material == parts.front().material && p.core == nullptr; });
}

}  // namespace

std::vector<MaterialPart> material_parts(const Taxonomy::Data& data, const ModelFacts& facts,
                                         const CategoryData& category, const MaterialChoice& surface) {
    std::vector<MaterialPart> parts;
    for (const PartFacts& part : facts.geometry.parts) {
        if (!can_be_real(part.form)) continue;
        const MaterialData* named = material_of_part(data, part.material);
        MaterialPart made{&part, named != nullptr ? named : surface.material, nullptr, 0};
        if (!category.solid) {
            made.usual_wall = made.material->wall.typical;
            made.core = data.material(made.material->core);
        }
        parts.push_back(made);
    }
    return parts;
}

double mass_of_parts(const std::vector<MaterialPart>& parts) { return total_mass(parts, 1); }

Substance substance_of(const std::vector<MaterialPart>& parts, const MaterialChoice& surface) {
    const MaterialData& outside = *surface.material;
    if (parts.empty() || (are_of_one_material(parts) && parts.front().material == &outside))
        return {outside.density, outside.name, outside.name + " (" + surface.source + "): " + outside.source,
                surface.level};
    Interval mass{};
    double volume = 0;
    const auto add = [&](const Interval& density, double amount) {
        mass.low += density.low * amount;
        mass.typical += density.typical * amount;
        mass.high += density.high * amount;
        volume += amount;
    };
    for (const MaterialPart& part : parts) {
        const Amount amount = amount_of(part, 1);
        add(part.material->density, amount.wall);
        if (part.core != nullptr) add(part.core->density, amount.core);
    }
    const std::string fractions = fractions_text(parts, 1);
    return {{mass.low / volume, mass.typical / volume, mass.high / volume},
            fractions,
            fractions + " of the mass by the names of its parts' materials, at usual walls",
            AttributeLevel::model};
}

std::optional<CenterAndInertia> spread_over(const std::vector<MaterialPart>& parts, double mass) {
    if (parts.empty() || !(mass > 0)) return std::nullopt;
    const double factor = fitting_walls(parts, mass);
    const auto is_filled = [&](const MaterialPart& p) {
        return p.facts->form.solid.volume > 0 && amount_of(p, factor).wall >= p.facts->form.solid.volume;
    };
    if (are_of_one_material(parts) && std::ranges::all_of(parts, is_filled)) return std::nullopt;

    // Where the walls cannot reach the mass (all parts filled, or cores too heavy), all densities are scaled alike.
    MassProperties whole;
    for (const MaterialPart& part : parts) whole = geometry::combined(whole, spread(part, factor));
    if (!(whole.volume > 0)) return std::nullopt;
    const bool has_walls = std::ranges::any_of(parts, [](const MaterialPart& p) { return p.usual_wall > 0; });
    std::string walls;
    if (has_walls) {
        walls = ", walls " + short_number(factor) + " times as thick as usual to make up the mass";
        if (factor == min_wall_factor) walls += ": the least, and still too heavy, so all parts are made lighter alike";
        if (factor == max_wall_factor) walls += ": the most, and still too light, so all parts are made heavier alike";
    }
    return CenterAndInertia{whole.center, (mass / whole.volume) * whole.inertia,
                            "spread over its parts (" + fractions_text(parts, factor) + ")" + walls,
                            AttributeLevel::model};
}

}  // namespace embody::attributes
