// SPDX-License-Identifier: MIT
// The drag is that of bodies smaller than a cell (J. M. Dallavalle, "Micromeritics", 2nd edition 1948; small_body.h),
// solved for the speed: with s = √v, (0.63 s² + 4.8 √(μ/(ρ d)) s)² = 8 F/(π ρ d²).
#include "physics/fluid/particles/settling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

double settling_speed(double density, double particle_volume, double acceleration, const Mixture::Around& around) {
    using std::numbers::pi;
    const double force = std::fabs(density / around.density - 1) * around.density * particle_volume * acceleration;
    const double diameter = std::cbrt(particle_volume * 6 / pi);
    const double a = 0.63, b = 4.8 * std::sqrt(around.viscosity / (around.density * diameter));
    const double root = std::sqrt(8 * force / (pi * around.density * diameter * diameter));
    // The positive root of a s² + b s = root, without cancellation.
    if (!(root > 0)) return 0;
    const double s = 2 * root / (b + std::sqrt(b * b + 4 * a * root));
    return s * s;
}

void settle(const FluidGrid& grid, const Mixture& liquids, std::size_t particle, const float* place,
            Vec3 apparent_gravity, double dt, float* shift) {
    const std::size_t own = liquids.liquid_of_particles()[particle];
    float gradient[3];
    double all = 0, own_volume = 0, slope = 0, density = 0, viscosity = 0;
    for (std::size_t i = 0; i < liquids.liquids().size(); ++i) {
        const double volume = sample_center(grid, grid.liquid_volume[i], place, gradient);
        all += volume;
        if (i == own) {
            own_volume = volume;
            slope = length(to_vec(gradient));
        }
        density += volume * liquids.liquids()[i].density;
        viscosity += volume * liquids.liquids()[i].viscosity;
    }
    // With the speed v of one liquid against the other and no net flow, each moves with v times the fraction of the
    // other. What has a surface the grid moves: where its side of one is flat, its fraction and its slope are more than
    // one.
    const double dispersed = 1 - (own_volume + slope) / all;
    const double acceleration = length(apparent_gravity);
    if (!(dispersed > 0) || !(acceleration > 0)) return;
    const FluidProperties& liquid = liquids.at(particle);
    const Mixture::Around around{density / all, viscosity / all};
    const double speed = settling_speed(liquid.density, liquid.particle_volume, acceleration, around);
    const double travel = (liquid.density < around.density ? -1 : 1) * dispersed * speed * dt;
    for (int axis = 0; axis < 3; ++axis)
        shift[axis] += static_cast<float>(travel * apparent_gravity[axis] / acceleration);
}

}  // namespace embody::physics::fluid
