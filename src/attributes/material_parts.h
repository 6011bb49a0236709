// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {

/// A part of a model with its material.
struct MaterialPart {
    const PartFacts* facts = nullptr;        ///< never null
    const MaterialData* material = nullptr;  ///< never null
    const MaterialData* core = nullptr;      ///< fills the space behind its walls, as foam in a cushion; null: nothing
    double usual_wall = 0;                   ///< m; 0: solid throughout
};

/// The parts of a model, each with the material that its name says, else with that of the whole model (`surface`).
/// Parts of a solid category have no walls.
std::vector<MaterialPart> material_parts(const Taxonomy::Data& data, const ModelFacts& facts,
                                         const CategoryData& category, const MaterialChoice& surface);

/// The material of a thing as a whole.
struct Substance {
    Interval density;  ///< kg/m³, of material without hollows
    std::string name;  ///< "steel", or "steel 60 %, glass 40 %" of the mass
    std::string source;
    AttributeLevel level = AttributeLevel::standard;
};

/// The mean of the parts' materials, Σ density × material volume over Σ material volume, where they differ; else the
/// surface's material. The material volume of a part is that of walls of their usual thickness and of the core behind
/// them.
Substance substance_of(const std::vector<MaterialPart>& parts, const MaterialChoice& surface);

/// The density sum: mass of the parts (kg) with walls of their usual thickness.
double mass_of_parts(const std::vector<MaterialPart>& parts);

/// Centre and inertia of parts that together have this mass (kg). Each part is between a shell and a solid; one factor
/// on the usual thickness of all walls makes the sum the mass. Empty where the result would say no more than the form
/// of the whole: parts not known, or all solid and of one material.
std::optional<CenterAndInertia> spread_over(const std::vector<MaterialPart>& parts, double mass);

}  // namespace embody::attributes
