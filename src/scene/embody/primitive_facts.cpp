// SPDX-License-Identifier: MIT
#include "scene/embody/primitive_facts.h"

#include "physics/definitions/mass_properties.h"
#include "physics/definitions/shape_bounds.h"

namespace embody::scene {

using attributes::ModelFacts;

namespace {

// Volume that the triangles enclose; 0 where they enclose none.
void put_enclosed(const physics::MeshShape& mesh, attributes::GeometryFacts& form) {
    const geometry::VolumeEstimate enclosed = physics::enclosed_by(mesh);
    form.closed = enclosed.method == geometry::VolumeMethod::closed_mesh;
    form.volume_method = geometry::name(enclosed.method);
    if (enclosed.method == geometry::VolumeMethod::no_volume) return;
    form.volume = enclosed.solid.volume;
    form.center_of_volume = enclosed.solid.center;
    form.unit_inertia = enclosed.solid.inertia;
    const auto hull = physics::mass_properties(hull_of(mesh));
    form.hull_volume = hull.ok() ? hull->volume : form.volume;
}

}  // namespace

physics::ShapeDefinition hull_of(const physics::MeshShape& mesh) {
    physics::HullShape hull;
    hull.points.reserve(mesh.positions.size());
    for (const Vec3f& position : mesh.positions) hull.points.push_back(to_vec3(position));
    return hull;
}

ModelFacts primitive_facts(const physics::ShapeDefinition& shape) {
    ModelFacts facts;
    attributes::GeometryFacts& form = facts.geometry;
    form.volume_method = "closed form";
    form.closed = true;
    const Bounds bounds = physics::bounds_of(shape);
    const bool has_extent = !bounds.is_empty() && !std::holds_alternative<physics::HeightfieldShape>(shape);
    if (physics::is_static_only(shape)) {
        if (has_extent) form.size = bounds.size();
        return facts;
    }
    const Result<geometry::MassProperties> solid = physics::mass_properties(shape);
    if (!solid.ok()) return facts;
    form.volume = form.hull_volume = solid->volume;
    form.center_of_volume = solid->center;
    form.unit_inertia = solid->inertia;
    form.size = bounds.size();
    return facts;
}

const ModelFacts& PrimitiveFacts::of_enclosed(const physics::MeshShape& mesh) {
    if (last_mesh_.first.positions == mesh.positions && last_mesh_.first.triangles == mesh.triangles)
        return last_mesh_.second;
    ModelFacts facts = primitive_facts(mesh);
    put_enclosed(mesh, facts.geometry);
    last_mesh_ = {mesh, std::move(facts)};
    return last_mesh_.second;
}

const ModelFacts& PrimitiveFacts::of(const physics::ShapeDefinition& shape) {
    GeometryKey key = key_of(shape);
    if (!key.is_shared()) return last_ = primitive_facts(shape);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    if (known_.size() >= max_known) known_.clear();
    return known_.emplace(std::move(key), primitive_facts(shape)).first->second;
}

}  // namespace embody::scene
