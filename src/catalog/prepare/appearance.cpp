// SPDX-License-Identifier: MIT
#include "catalog/prepare/appearance.h"

#include <map>

namespace embody::catalog {
namespace {

constexpr std::string_view pane_prefix = "sweethome3d_window_pane";
constexpr float pane_opacity = 0.5F;  // as in Sweet Home 3D

// Frames share their material with panes, so that these get one of their own.
void make_panes_glass(interchange::RawScene& scene) {
    std::map<int, int> glass_of;
    for (interchange::RawMesh& mesh : scene.meshes) {
        if (!mesh.name.starts_with(pane_prefix)) continue;
        interchange::RawMaterial material;
        if (mesh.material >= 0) material = scene.materials[static_cast<std::size_t>(mesh.material)];
        if (material.base_color[3] < 1) continue;
        const auto [known, is_new] = glass_of.try_emplace(mesh.material, static_cast<int>(scene.materials.size()));
        if (is_new) {
            material.name = "glass";
            material.base_color[3] = pane_opacity;
            scene.materials.push_back(std::move(material));
        }
        mesh.material = known->second;
    }
}

void recolor(interchange::RawScene& scene, const interchange::Recolor& wanted) {
    for (interchange::RawMaterial& material : scene.materials) {
        const bool is_meant = wanted.material.empty() ? material.base_color[3] >= 1 : material.name == wanted.material;
        if (!is_meant) continue;
        for (std::size_t k = 0; k < 3; ++k) material.base_color[k] = static_cast<float>(wanted.color[k]);
        material.base_color_image = -1;
    }
}

}  // namespace

void set_appearance(interchange::RawScene& scene, const ImportItem& item) {
    make_panes_glass(scene);
    for (const interchange::Recolor& wanted : item.recolors) recolor(scene, wanted);
}

}  // namespace embody::catalog
