// SPDX-License-Identifier: MIT
#include <algorithm>

#include "attributes/assemble.h"
#include "physics/definitions/grain_material.h"
#include "physics/definitions/mass_properties.h"
#include "scene/embody/entity_body.h"
#include "scene/embody/entity_points.h"
#include "scene/embody/grain_filling.h"

namespace embody::scene {

Result<GrainDefinition> EntityPoints::grains(const Entity& entity, const attributes::AttributeSet& attributes) {
    Result<physics::ShapeDefinition> filled = shape_of(entity, attributes, models_);
    if (!filled.ok()) return filled.error();
    Result<physics::BodyDefinition> body = body_of(entity, attributes, models_.taxonomy());
    if (!body.ok()) return body.error();
    GrainDefinition grains;
    grains.body = std::move(body).value();
    grains.diameter = attributes.number("simulated_diameter", 0.01);
    if (entity.kept) {
        grains.centers = places_of(*entity.kept);
    } else {
        const auto budget = static_cast<std::size_t>(attributes.number("grain_budget", 2000));
        Result<std::vector<Vec3>> centers = fill_with_grains(filled.value(), grains.diameter, budget, entity.index);
        if (!centers.ok()) return centers.error();
        grains.centers = std::move(centers).value();
    }

    // The mass of all grains together is that of the thing.
    const double volume = physics::mass_properties(physics::SphereShape{grains.diameter / 2}).volume;
    const double mass = attributes.number("mass", 1) / static_cast<double>(grains.centers.size());
    grains.body.mass = {.density = std::clamp(mass / volume, 1e-3, 1e5)};

    // A pile absorbs the energy of things that fall on it, so grains bounce only where a person sets it.
    const physics::Material own = grains.body.material;
    physics::Material& material = grains.body.material;
    material = physics::grain_material(attributes.number("friction_angle", 34), grains.diameter);
    material.restitution_combine = physics::CombineRule::multiply;
    if (attributes::is_manual(attributes, "restitution")) {
        material.restitution = own.restitution;
        material.restitution_threshold = own.restitution_threshold;
        material.restitution_combine = own.restitution_combine;
    }
    return grains;
}

}  // namespace embody::scene
