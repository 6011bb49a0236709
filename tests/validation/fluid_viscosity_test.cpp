// SPDX-License-Identifier: MIT
// Viscous liquids beside formulas: a film on an incline, and what a yield stress holds.
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double film_depth = 0.04, film_tilt = 0.2, film_length = 1.2, film_density = 1400;

// Mean speed in the middle of a long and wide film, before its rims are felt there, m/s. Gravity is tilted and not the
// ground.
double film_speed(double viscosity, double yield_stress, double cell) {
    auto world = make_world({.gravity = {gravity * std::sin(film_tilt), -gravity * std::cos(film_tilt), 0}});
    add_box(*world, {2, 0.25, 0.5}, {.kind = BodyKind::static_body, .position = {0, -0.25, 0}});
    const auto honey = world
                           ->create_fluid({.boxes = {{{-film_length / 2, 0, -0.3}, {film_length / 2, film_depth, 0.3}}},
                                           .density = film_density,
                                           .viscosity = viscosity,
                                           .yield_stress = yield_stress,
                                           .cell_size = cell})
                           .value();
    run(*world, 0.5);
    const FluidParticles particles = world->fluid_particles(honey);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < particles.positions.size(); ++i) {
        const Vec3 p = particles.origin + Vec3(particles.positions[i]);
        if (std::fabs(p.x) > 0.05 || std::fabs(p.z) > 0.05) continue;
        sum += static_cast<double>(particles.velocities[i].x);
        ++count;
    }
    return sum / std::max(count, 1);
}

// u(y) = ρ g sin α / μ (H y − y²/2), mean ρ g sin α H² / (3 μ); reached as exp(−π²ν t/(4H²)).
double nusselt_speed(double viscosity) {
    return film_density * gravity * std::sin(film_tilt) * film_depth * film_depth / (3 * viscosity);
}

TEST(FluidViscosity, AFilmOnAnInclineFlowsAsFastAsNusseltSays) {
    for (const double cell : {0.02, 0.01}) {
        const double viscosity = 10, expected = nusselt_speed(viscosity), speed = film_speed(viscosity, 0, cell);
        RecordProperty("film_ratio_" + std::to_string(cell), std::to_string(speed / expected));
        EXPECT_NEAR(speed, expected, 0.05 * expected) << cell;
    }
}

TEST(FluidViscosity, HoneyFlowsSlowerThanOil) {
    const double honey = film_speed(20, 0, 0.02), oil = film_speed(10, 0, 0.02);
    EXPECT_NEAR(oil / honey, 2, 0.1);
}

TEST(FluidViscosity, AYieldStressSlowsTheFilmAsBinghamSaysAndHoldsItAboveTheStressAtTheGround) {
    // φ = yield stress / stress at the ground: mean speed times 1 − 3/2 φ + φ³/2, none from φ = 1 on.
    const double viscosity = 10, newtonian = nusselt_speed(viscosity);
    const double at_ground = film_density * gravity * std::sin(film_tilt) * film_depth;
    const double speed = film_speed(viscosity, 0.4 * at_ground, 0.01);
    const double expected = newtonian * (1 - 1.5 * 0.4 + 0.5 * 0.4 * 0.4 * 0.4);
    RecordProperty("bingham_ratio", std::to_string(speed / expected));
    EXPECT_NEAR(speed, expected, 0.25 * expected);
    const double held = film_speed(viscosity, 1.3 * at_ground, 0.01);
    RecordProperty("held_ratio", std::to_string(held / newtonian));
    EXPECT_LT(held, 0.03 * newtonian);
}

}  // namespace
}  // namespace embody::physics
