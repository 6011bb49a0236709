// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"
#include "physics/definitions/handles.h"

namespace embody::physics {

/// A body of liquid. Its volume at the start is the union of boxes, convex hulls and single particles, all in world
/// coordinates, without what bodies fill. Fluids do not interact: two of them pass through each other. Liquids that
/// meet are of one fluid: World::set_liquid.
struct FluidDefinition {
    std::vector<Bounds> boxes;             ///< m
    std::vector<std::vector<Vec3>> hulls;  ///< the convex hull of each list of points, m
    std::vector<Vec3> points;              ///< centres of particles, each of cell_size³ / 8, m
    Vec3 velocity;                         ///< of all of it at the start, m/s
    double density = 998;                  ///< kg/m³, 1 … 25,000
    double viscosity = 0.001;              ///< dynamic, Pa s, 0 … 10,000
    double yield_stress = 0;               ///< Bingham's: shear stress below which it does not flow, Pa, 0 … 10,000
    double surface_tension = 0;  ///< N/m, 0 … 10; on cells finer than 2 √(σ/(ρ g)), and of drops at walls
    double cell_size = 0.02;     ///< edge of the cells it is solved on, m, 0.001 … 1; a full cell has eight particles
    double gravity_factor = 1;   ///< -10 … 10
    bool allow_sleep = true;     ///< may sleep while nothing moves in it
    bool starts_empty = false;   ///< nothing of its volume is there yet: the volume tells where sources will pour
    std::uint64_t user_data = 0;  ///< the library never reads it
};

/// What one of the liquids of a fluid is made of; limits as in FluidDefinition.
struct LiquidMatter {
    double density = 998;        ///< kg/m³
    double viscosity = 0.001;    ///< dynamic, Pa s
    double yield_stress = 0;     ///< Pa
    double surface_tension = 0;  ///< N/m

    bool operator==(const LiquidMatter&) const = default;
};

/// Maximum number of particles of a fluid.
inline constexpr std::size_t max_fluid_particles = 4'000'000;

/// The error's `where` is the field, e.g. "boxes[2].lower.x".
Result<void> validate(const FluidDefinition& definition);
Result<void> validate(const LiquidMatter& matter);

/// A fluid's particles as they are now; valid until the world changes.
struct FluidParticles {
    Vec3 origin;                         ///< of the positions, world, m
    std::span<const Vec3f> positions;    ///< from the origin, world axes, m
    std::span<const Vec3f> velocities;   ///< m/s
    std::span<const std::uint32_t> ids;  ///< of each particle for its whole life; their order changes
    double particle_volume = 0;          ///< m³
    Bounds bounds;                       ///< of the positions, world, m
    double cell_size = 0;                ///< m; neighbours in liquid at rest are half of it apart
    bool is_asleep = false;              ///< the fluid sleeps: nothing has changed since the last step
    bool is_frozen = false;              ///< its numbers became non-finite: it stands still for good
    std::uint64_t version = 0;           ///< a new value whenever any of them changed
};

/// Ids from `first` to below `last`.
struct FluidIds {
    std::uint32_t first = 0, last = 0;

    [[nodiscard]] bool contains(std::uint32_t id) const { return id >= first && id < last; }
};

/// A particle to be: m, world, and m/s.
struct FluidDrop {
    Vec3 position, velocity;
};

/// Particles of a fluid.
struct FluidPart {
    FluidHandle fluid;
    FluidIds ids;
};

/// Position (m, world) and velocity (m/s) of a particle, to be changed; false takes it away.
using FluidChange = std::function<bool(std::uint32_t id, Vec3& position, Vec3& velocity)>;

/// What fluids did to a body, mean over the last step, world axes: N, and N m about its centre of mass.
struct FluidForce {
    Vec3 force, torque;
};

}  // namespace embody::physics
