// SPDX-License-Identifier: MIT
#include "attributes/material_presets.h"

#include <algorithm>
#include <cctype>

#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

constexpr std::array preset_materials{"wood",  "steel",     "plastic", "rubber",    "glass",    "ice",
                                      "stone", "aluminium", "ceramic", "foam",      "concrete", "cardboard",
                                      "cork",  "leather",   "fabric",  "cast_iron", "lead",     "brass",
                                      "brick", "composite", "wax",     "titanium"};

std::string label_of(std::string name) {
    std::ranges::replace(name, '_', ' ');
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return name;
}

}  // namespace

std::vector<MaterialPreset> material_presets(const Taxonomy& taxonomy) {
    std::vector<MaterialPreset> presets;
    for (const char* name : preset_materials)
        if (const MaterialData* material = taxonomy.data().material(name))
            presets.push_back({label_of(name), material});
    return presets;
}

Result<MaterialPreset> preset_named(const Taxonomy& taxonomy, std::string_view name) {
    std::string all;
    for (const MaterialPreset& preset : material_presets(taxonomy)) {
        if (preset.material->name == name) return preset;
        all += (all.empty() ? "" : ", ") + preset.material->name;
    }
    return Error{"preset", "\"" + std::string(name) + "\" is no preset", "use one of " + all};
}

}  // namespace embody::attributes
