// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "attributes/physical_kind.h"
#include "attributes/to_physics.h"
#include "scene/embody/entity_points.h"

namespace embody::scene {

namespace {

// Collision radius as a fraction of the cell size, and its bounds (m): small beside the drawn form, large beside
// rounding errors.
constexpr double radius_fraction = 0.02, min_radius = 5e-4, max_radius = 5e-3;

}  // namespace

std::vector<std::uint32_t> pinned_nodes(const Pin& pin, const std::vector<Vec3>& nodes) {
    std::vector<std::uint32_t> within;
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const double distance = length(nodes[i] - pin.position);
        if (distance <= pin.radius) within.push_back(i);
        if (distance < length(nodes[nearest] - pin.position)) nearest = i;
    }
    if (within.empty()) within.push_back(nearest);
    return within;
}

Result<physics::DeformableDefinition> EntityPoints::soft(const Entity& entity,
                                                         const attributes::AttributeSet& attributes) {
    const Result<const catalog::SoftMesh*> mesh = meshes_.soft_mesh(entity, attributes);
    if (!mesh.ok()) return mesh.error();
    geometry::TetrahedralMesh scaled = mesh.value()->mesh;
    for (Vec3& node : scaled.nodes) node *= entity.scale;
    Result<physics::DeformableDefinition> made =
        attributes::soft_solid_from_attributes(attributes, scaled, models_.taxonomy());
    if (!made.ok()) return Error{"attributes: " + made.error().where, made.error().why, made.error().remedy};
    physics::DeformableDefinition soft = std::move(made).value();
    soft.contact_radius = std::clamp(radius_fraction * mesh.value()->cell * entity.scale, min_radius, max_radius);
    return soft;
}

Result<physics::DeformableDefinition> EntityPoints::placed(const Entity& entity,
                                                           Result<physics::DeformableDefinition> made) {
    if (!made.ok()) return made.error();
    physics::DeformableDefinition deformable = std::move(made).value();
    deformable.pose = entity.pose;
    deformable.linear_velocity = entity.linear_velocity;
    deformable.angular_velocity = entity.angular_velocity;
    deformable.force = entity.force;
    deformable.enabled = entity.enabled;
    deformable.user_data = entity.index;
    for (const Pin& pin : entity.pins) {
        if (pin.to) continue;
        const std::vector<std::uint32_t> held = pinned_nodes(pin, deformable.nodes);
        deformable.pinned.insert(deformable.pinned.end(), held.begin(), held.end());
    }
    std::ranges::sort(deformable.pinned);
    deformable.pinned.erase(std::unique(deformable.pinned.begin(), deformable.pinned.end()), deformable.pinned.end());
    return deformable;
}

}  // namespace embody::scene
