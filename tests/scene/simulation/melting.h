// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "foundation/random.h"
#include "scene/live_scene.h"
#include "scene/matter/momenta.h"
#include "scene/sample_documents.h"
#include "scene/simulation/tub.h"

namespace embody::scene::samples {

/// What an entity that moves along +X does in its third step.
inline Action at_third_step(const Document& document, EntityIndex entity, const Effect& effect) {
    const auto simulation = make(document);
    step(*simulation, 2);
    const auto place = [&] {
        const MovingPoints* points = simulation->points(entity);
        return points ? points->center_of_mass().x : simulation->world().center_of_mass(simulation->body(entity)).x;
    };
    const double before = place();
    step(*simulation, 1);
    return {.id = 1,
            .sender = {Target::By::index, entity, {}},
            .trigger = OnEnterVolume{{{(before + place()) / 2, -1e3, -1e3}, {1e3, 1e3, 1e3}}},
            .effect = effect};
}

inline Quat any_rotation(Random& random) {
    return from_axis_angle(normalized({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}, {1, 0, 0}),
                           random.between(0, 3));
}

inline Vec3 any_vector(Random& random, double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

inline physics::ShapeDefinition any_shape(Random& random, int kind) {
    const auto length = [&] { return random.between(0.03, 0.12); };
    switch (kind % 6) {
        case 0:
            return physics::BoxShape{{length(), length(), length()}};
        case 1:
            return physics::SphereShape{length()};
        case 2:
            return physics::CapsuleShape{length(), length()};
        case 3:
            return physics::CylinderShape{length(), length()};
        case 4:
            return physics::ConeShape{length(), length()};
        default: {
            physics::HullShape hull;
            for (int i = 0; i < 12; ++i) hull.points.push_back(any_vector(random, 0.12));
            return hull;
        }
    }
}

/// Momenta of a body, about its centre of mass.
inline Momenta momenta_of_body(const Simulation& simulation, EntityIndex index) {
    const physics::World& world = simulation.world();
    const physics::BodyHandle body = simulation.body(index);
    const Quat rotation = world.pose(body).rotation;
    return {world.mass(body), world.center_of_mass(body), world.mass(body) * world.linear_velocity(body),
            rotate(rotation, world.inertia(body) * rotate_inverse(rotation, world.angular_velocity(body)))};
}

inline double energy_of_body(const Simulation& simulation, EntityIndex index) {
    const Momenta momenta = momenta_of_body(simulation, index);
    const physics::World& world = simulation.world();
    const physics::BodyHandle body = simulation.body(index);
    return (dot(momenta.linear, world.linear_velocity(body)) + dot(momenta.angular, world.angular_velocity(body))) / 2;
}

struct Drops {
    std::vector<Vec3> places, velocities;
    double mass = 0;  ///< of each, kg

    [[nodiscard]] Momenta momenta() const { return momenta_of(places, velocities, mass); }
    [[nodiscard]] double energy() const {
        double sum = 0;
        for (const Vec3 velocity : velocities) sum += mass * dot(velocity, velocity) / 2;
        return sum;
    }
};

inline Drops drops_of(const Simulation& simulation, EntityIndex liquid, std::size_t after = 0) {
    Drops drops;
    const MovingPoints& points = *simulation.points(liquid);
    points.read(drops.places);
    points.read_velocities(drops.velocities);
    drops.mass = points.mass() / static_cast<double>(drops.places.size());
    drops.places.erase(drops.places.begin(), drops.places.begin() + static_cast<std::ptrdiff_t>(after));
    drops.velocities.erase(drops.velocities.begin(), drops.velocities.begin() + static_cast<std::ptrdiff_t>(after));
    return drops;
}

/// The angular momentum about a place.
inline Vec3 angular_about(const Momenta& momenta, Vec3 place) {
    return momenta.angular + cross(momenta.center - place, momenta.linear);
}

}  // namespace embody::scene::samples
