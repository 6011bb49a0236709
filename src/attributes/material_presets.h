// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/resolver.h"

namespace embody::attributes {

struct MaterialData;

/// Attributes that follow from a thing's material: a value of them that a person set hides what the material says.
inline constexpr std::array decided_by_material{
    "mass",    "density",         "bulk_density",     "area_density",     "linear_density",
    "inertia", "friction_static", "friction_dynamic", "friction_rolling", "restitution"};

/// A material that people choose for a whole thing.
struct MaterialPreset {
    std::string label;  ///< "Cast iron"
    const MaterialData* material = nullptr;
};

/// The materials of the taxonomy that whole things are made of, from common to rare: no liquids, powders or food. They
/// are valid as long as the taxonomy.
std::vector<MaterialPreset> material_presets(const Taxonomy& taxonomy);
/// The preset with this name ("cast_iron"), or an error that names them all.
Result<MaterialPreset> preset_named(const Taxonomy& taxonomy, std::string_view name);

}  // namespace embody::attributes
