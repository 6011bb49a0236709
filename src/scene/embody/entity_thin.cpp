// SPDX-License-Identifier: MIT
// Entities of kind cloth and rope: their sheets and lines (docs/physics/cloth.md).
#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "attributes/to_physics.h"
#include "scene/embody/closed_sheet.h"
#include "scene/embody/entity_points.h"

namespace embody::scene {

using attributes::PhysicalKind;

namespace {

// Collision radius of cloth: half of its thickness, but at least this fraction of an edge, so that corners between
// nodes do not show. Bounds in m.
constexpr double sheet_radius_fraction = 0.03, sheet_min_radius = 1e-3, sheet_max_radius = 0.02;
constexpr double min_rope_radius = 5e-4, max_rope_radius = 0.5;

double mean_edge(const attributes::SheetMesh& sheet) {
    double sum = 0;
    for (const auto& [a, b, c] : sheet.triangles) {
        sum += length(sheet.nodes[b] - sheet.nodes[a]) + length(sheet.nodes[c] - sheet.nodes[b]) +
               length(sheet.nodes[a] - sheet.nodes[c]);
    }
    return sum / (3 * static_cast<double>(sheet.triangles.size()));
}

Error in_attributes(const Error& error) { return {"attributes: " + error.where, error.why, error.remedy}; }

}  // namespace

Result<physics::DeformableDefinition> EntityPoints::thin(const Entity& entity,
                                                         const attributes::AttributeSet& attributes) {
    const Result<const ThinForm*> form = meshes_.thin_form(entity, attributes);
    if (!form.ok()) return form.error();
    if (const auto* line = std::get_if<LineForm>(form.value())) {
        std::vector<Vec3> nodes = line->nodes;
        for (Vec3& node : nodes) node *= entity.scale;
        const double diameter = line->diameter * entity.scale;
        Result<physics::DeformableDefinition> rope =
            attributes::rope_from_attributes(attributes, nodes, diameter, models_.taxonomy());
        if (!rope.ok()) return in_attributes(rope.error());
        rope.value().contact_radius = std::clamp(diameter / 2, min_rope_radius, max_rope_radius);
        return rope;
    }
    attributes::SheetMesh sheet = std::get<attributes::SheetMesh>(*form.value());
    for (Vec3& node : sheet.nodes) node *= entity.scale;
    Result<physics::DeformableDefinition> cloth =
        attributes::cloth_from_attributes(attributes, sheet, models_.taxonomy());
    if (!cloth.ok()) return in_attributes(cloth.error());
    if (!is_closed(sheet)) std::get<physics::Cloth>(cloth.value().matter).inflation = 0;
    const double half = std::get<physics::Cloth>(cloth.value().matter).thickness / 2;
    cloth.value().contact_radius =
        std::clamp(std::max(half, sheet_radius_fraction * mean_edge(sheet)), sheet_min_radius, sheet_max_radius);
    return cloth;
}

}  // namespace embody::scene
