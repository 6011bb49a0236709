// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "foundation/task_pool.h"
#include "math/vec3.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// A parcel of liquid: a cache line. Lengths in metres, in world axes from the fluid's origin.
struct FluidParticle {
    float position[3] = {};
    float velocity[3] = {};  ///< m/s
    /// Gradient of each velocity component (its row of the affine field of Jiang and others 2015), 1/s.
    float affine[3][3] = {};
    std::uint32_t id = 0;
};
static_assert(sizeof(FluidParticle) == 64);

/// A particle's position or velocity.
inline Vec3 to_vec(const float* p) { return {p[0], p[1], p[2]}; }

/// Loops over fewer particles run on one worker.
inline constexpr std::size_t few_particles = 1000;

/// The box of particles' places and their largest speed.
struct ParticleReach {
    std::array<float, 3> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};  ///< m
    float fastest_squared = 0;                                                                         ///< m²/s²
    float zero = 0;  ///< not a number if any place or velocity was not a number

    void add(const ParticleReach& other);
    [[nodiscard]] bool is_finite() const { return zero == 0; }
    /// Largest coordinate, m; infinity without particles, or if a coordinate is not finite.
    [[nodiscard]] float farthest() const;
};
ParticleReach reach_of(std::span<const FluidParticle> particles, TaskPool& workers);

/// The speed below which all but 1 in `particles_per_outlier` stay, m/s, at most 1 % too large.
double usual_speed_of(std::span<const FluidParticle> particles, std::size_t particles_per_outlier, TaskPool& workers);

}  // namespace embody::physics::fluid
