// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {

inline BodyHandle add_box(World& world, Vec3 half_extents, BodyDefinition definition) {
    definition.shape = world.create_shape(BoxShape{half_extents}).value();
    return world.create_body(definition).value();
}

/// An open tank of five boxes around the region: static walls, a kinematic bottom, which tells the force on it.
inline BodyHandle add_tank(World& world, const Bounds& inside, double thickness = 0.5) {
    const Vec3 middle = inside.center(), half = inside.half_extents();
    const double t = thickness / 2;
    for (const int side : {-1, 1}) {
        add_box(world, {t, half.y + t, half.z + 2 * t},
                {.kind = BodyKind::static_body, .position = middle + Vec3{side * (half.x + t), 0, 0}});
        add_box(world, {half.x, half.y + t, t},
                {.kind = BodyKind::static_body, .position = middle + Vec3{0, 0, side * (half.z + t)}});
    }
    return add_box(world, {half.x, t, half.z},
                   {.kind = BodyKind::kinematic_body, .position = {middle.x, inside.lower.y - t, middle.z}});
}

/// Volume of all its particles, m³.
inline double volume_of(const World& world, FluidHandle fluid) {
    const FluidParticles particles = world.fluid_particles(fluid);
    return particles.particle_volume * static_cast<double>(particles.positions.size());
}

/// Largest coordinate of its particles along an axis, world, m.
inline double farthest(const World& world, FluidHandle fluid, int axis) {
    const FluidParticles particles = world.fluid_particles(fluid);
    double most = -1e300;
    for (const Vec3f p : particles.positions) most = std::max(most, particles.origin[axis] + Vec3(p)[axis]);
    return most;
}

}  // namespace embody::physics
