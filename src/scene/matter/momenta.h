// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"

namespace embody::scene {

/// What a thing's matter has and keeps when it becomes other matter.
struct Momenta {
    double mass = 0;  ///< kg
    Vec3 center;      ///< of mass, m, world
    Vec3 linear;      ///< N s
    Vec3 angular;     ///< about the centre of mass, N m s
};

/// Of particles of one mass each (kg): their moments about their mean place.
struct ParticleMoments {
    Vec3 mean;     ///< m
    Mat3 inertia;  ///< kg m²
};
ParticleMoments moments_of(std::span<const Vec3> places, double mass);

/// Momenta of particles of one mass each (kg) that move so.
Momenta momenta_of(std::span<const Vec3> places, std::span<const Vec3> velocities, double mass);

/// Whether no line holds all the places: then their velocities can have any angular momentum.
bool can_turn(const ParticleMoments& moments);

/// The velocities nearest to `velocities`, by mass, with which particles of one mass each (kg) have these linear and
/// angular momenta, in single precision as the particles of a fluid. They must be able to turn.
std::vector<Vec3> with_momenta(std::span<const Vec3> places, std::span<const Vec3> velocities, double mass,
                               const Momenta& momenta);

}  // namespace embody::scene
