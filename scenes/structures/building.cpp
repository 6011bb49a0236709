// SPDX-License-Identifier: MIT
#include "scenes/structures/building.h"

#include <utility>

namespace embody::scenes {

Building::Building(const physics::WorldSettings& settings, const physics::Material& material) : material_(material) {
    structure_.world = std::move(physics::World::create(settings)).value();
    add_static(shape(physics::PlaneShape{}), {});
}

physics::ShapeHandle Building::shape(const physics::ShapeDefinition& definition) {
    return structure_.world->create_shape(definition).value();
}

physics::BodyHandle Building::create(const physics::BodyDefinition& definition) {
    return structure_.world->create_body(definition).value();
}

void Building::add(physics::ShapeHandle shape, Vec3 position, Quat rotation, double mass) {
    physics::MassDefinition given{.density = density_};
    if (mass > 0) given.mass = mass;
    const auto body =
        create({.shape = shape, .position = position, .rotation = rotation, .mass = given, .material = material_});
    structure_.pieces.push_back({body, structure_.world->center_of_mass(body)});
}

void Building::drop(physics::ShapeHandle shape, Vec3 from, Vec3 position) {
    add(shape, from);
    structure_.pieces.back().place += position - from;
}

void Building::add_static(physics::ShapeHandle shape, Vec3 position) {
    create({.kind = physics::BodyKind::static_body, .shape = shape, .position = position, .material = material_});
}

Structure Building::take(double fallen) {
    structure_.fallen = fallen;
    return std::move(structure_);
}

}  // namespace embody::scenes
