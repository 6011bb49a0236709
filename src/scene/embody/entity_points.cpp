// SPDX-License-Identifier: MIT
#include "scene/embody/entity_points.h"

#include <cmath>
#include <initializer_list>

#include "attributes/physical_kind.h"
#include "scene/embody/entity_body.h"

namespace embody::scene {

using attributes::Matter;
using attributes::PhysicalKind;

namespace {

const std::string rigid_because = "is simulated as rigid, because ";

// Equal keys mean equal shape, kind and values of these attributes.
GeometryKey points_key(const Entity& entity, const attributes::AttributeSet& attributes,
                       std::initializer_list<const char*> names) {
    GeometryKey key = shape_key(entity, attributes);
    key.words.push_back(to_text(kind_of(attributes)));
    for (const char* name : names) key.numbers.push_back(attributes.number(name, 0));
    return key;
}

bool asks_for_gas(const attributes::AttributeSet& attributes) {
    return matter_of(attributes) == Matter::sheet && attributes.number("internal_pressure", 0) > 0;
}

// Equal keys mean equal nodes of a deformable.
GeometryKey deformable_key(const Entity& entity, const attributes::AttributeSet& attributes) {
    GeometryKey key = points_key(entity, attributes, {"cloth_nodes", "rope_segments", "soft_resolution"});
    key.numbers.push_back(entity.scale);
    // A sheet that holds gas is closed.
    if (asks_for_gas(attributes)) key.words.emplace_back("gas");
    return key;
}

bool is_closed_sheet(const ThinForm& form) {
    const auto* sheet = std::get_if<attributes::SheetMesh>(&form);
    return sheet != nullptr && is_closed(physics::Cloth{.triangles = sheet->triangles});
}

EntityForm particles_form(const Entity& entity, GeometryKey key, double budget, bool is_liquid) {
    KeptFit fit = fit_of_particles(key, entity.geometry, static_cast<std::size_t>(budget), is_liquid);
    // A drain may have taken all of a liquid.
    if (is_liquid) fit.min_points = 0;
    return {true, std::move(key), {}, fit};
}

}  // namespace

Result<void> EntityPoints::check_kept(const Entity& entity, const attributes::AttributeSet& attributes) {
    if (!entity.kept) return {};
    return scene::check_kept(*entity.kept, form(entity, attributes, false).kept_fit);
}

EntityForm EntityPoints::soft_form(const Entity& entity, const attributes::AttributeSet& attributes) {
    const Result<const catalog::SoftMesh*> mesh = meshes_.soft_mesh(entity, attributes);
    if (!mesh.ok()) return {false, {}, rigid_because + mesh.error().why, {}};
    EntityForm soft{true, deformable_key(entity, attributes), {}, {}};
    soft.kept_fit = fit_of_mesh(soft.points_key, entity.geometry, *mesh.value());
    if (mesh.value()->flatness > 1)
        soft.note = "is so flat that it is computed coarsely, on cells " +
                    std::to_string(std::lround(mesh.value()->flatness)) + " times as wide as thick";
    return soft;
}

EntityForm EntityPoints::form(const Entity& entity, const attributes::AttributeSet& attributes, bool is_held_as_body) {
    const PhysicalKind kind = kind_of(attributes);
    const Matter matter = traits_of(kind).matter;
    if (is_held_as_body && (is_deformable(kind) || matter == Matter::liquid))
        return {false, {}, rigid_because + "a joint or a pin holds on to it", {}};
    switch (matter) {
        case Matter::none:
        case Matter::body:
            return {};
        case Matter::grains:
            return particles_form(entity, points_key(entity, attributes, {"simulated_diameter", "grain_budget"}),
                                  attributes.number("grain_budget", 2000), false);
        case Matter::liquid: {
            GeometryKey key = points_key(entity, attributes, {"fluid_cell_size", "particle_budget"});
            if (entity.starts_empty) key.words.emplace_back("starts_empty");
            return particles_form(entity, std::move(key),
                                  attributes.number("particle_budget", 20000) * max_particles_ratio, true);
        }
        case Matter::solid:
            return soft_form(entity, attributes);
        case Matter::sheet:
        case Matter::line: {
            const Result<const ThinForm*> thin = meshes_.thin_form(entity, attributes);
            if (!thin.ok()) return {false, {}, rigid_because + thin.error().why, {}};
            EntityForm form{true, deformable_key(entity, attributes), {}, {}};
            form.kept_fit = fit_of_mesh(form.points_key, entity.geometry, *thin.value());
            if (asks_for_gas(attributes) && !is_closed_sheet(*thin.value()))
                form.note = "holds no gas, because it encloses no room or parts of it meet in edges only";
            return form;
        }
    }
    return {};
}

Result<PointsDefinition> EntityPoints::definition(const Entity& entity, const attributes::AttributeSet& attributes) {
    const auto as_points = [](auto made) -> Result<PointsDefinition> {
        if (!made.ok()) return made.error();
        return PointsDefinition(std::move(made).value());
    };
    switch (matter_of(attributes)) {
        case Matter::grains:
            return as_points(grains(entity, attributes));
        case Matter::liquid:
            return as_points(liquid(entity, attributes));
        case Matter::solid:
            return as_points(placed(entity, soft(entity, attributes)));
        case Matter::sheet:
        case Matter::line:
            return as_points(placed(entity, thin(entity, attributes)));
        case Matter::none:
        case Matter::body:
            break;
    }
    return Error{"attributes.kind", "a " + to_text(kind_of(attributes)) + " thing is one body, not points"};
}

}  // namespace embody::scene
