// SPDX-License-Identifier: MIT
// Bodies smaller than a cell: the speed at which drag and buoyancy hold their weight.
#include <cmath>

#include "foundation/random.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

// Of a sphere in water: C_d = 24 / Re (1 + 0.15 Re^0.687) below Re = 1000, 0.44 above (L. Schiller, A. Naumann, 1933).
double speed_of_fall(double radius, double density) {
    constexpr double water = 998, viscosity = 0.001, pi = 3.14159265358979;
    const double weight = 4.0 / 3 * pi * radius * radius * radius * (density - water) * gravity;
    double low = 0, high = 20;
    for (int i = 0; i < 60; ++i) {
        const double speed = (low + high) / 2, reynolds = water * speed * 2 * radius / viscosity;
        const double c = reynolds < 1000 ? 24 / reynolds * (1 + 0.15 * std::pow(reynolds, 0.687)) : 0.44;
        (c * water / 2 * speed * speed * pi * radius * radius < weight ? low : high) = speed;
    }
    return low;
}

struct Ball {
    double radius, density;
};

TEST(FluidSmallBody, BallsSinkAsFastAsSchillerAndNaumannMeasured) {
    constexpr double side = 0.48, depth = 1.2;
    auto world = make_world({});
    add_tank(*world, {{0, 0, 0}, {side, 1.6, side}});
    const auto water =
        world->create_fluid({.boxes = {{{0, 0, 0}, {side, depth, side}}}, .cell_size = 0.04, .allow_sleep = false});
    ASSERT_TRUE(water);
    run(*world, 0.5);
    for (const Ball ball : {Ball{0.005, 7850}, Ball{0.01, 2500}, Ball{0.01, 1200}}) {
        const BodyHandle body = world
                                    ->create_body({.shape = world->create_shape(SphereShape{ball.radius}).value(),
                                                   .position = {side / 2, 1, side / 2},
                                                   .mass = {.density = ball.density}})
                                    .value();
        double speed = 0;
        for (int i = 0; i < 300 && world->center_of_mass(body).y > 0.5; ++i) {
            world->step();
            speed = -world->linear_velocity(body).y;
        }
        const double ratio = speed / speed_of_fall(ball.radius, ball.density);
        RecordProperty("ratio_" + std::to_string(std::lround(ball.density)), std::to_string(ratio));
        EXPECT_NEAR(ratio, 1, 0.1) << ball.radius << " " << ball.density;
        // It falls without acceleration: water holds its whole weight.
        const double weight = world->mass(body) * gravity;
        EXPECT_NEAR(world->fluid_force(body).force.y, weight, 0.03 * weight);
        ASSERT_TRUE(world->destroy_body(body));
    }
}

TEST(FluidSmallBody, ALightBallRisesAndFloats) {
    auto world = make_world({});
    add_tank(*world, {{0, 0, 0}, {0.4, 0.8, 0.4}});
    ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0, 0}, {0.4, 0.4, 0.4}}}, .cell_size = 0.04}));
    const BodyHandle ball = world
                                ->create_body({.shape = world->create_shape(SphereShape{0.012}).value(),
                                               .position = {0.2, 0.1, 0.2},
                                               .mass = {.density = 500}})
                                .value();
    run(*world, 4);
    // Its centre is at the surface: half of it displaces its weight. What it fills is spread over a cell.
    EXPECT_NEAR(world->center_of_mass(ball).y, 0.4, 0.03);
    EXPECT_NEAR(world->linear_velocity(ball).y, 0, 0.05);
}

TEST(FluidSmallBody, DragKeepsMomentum) {
    auto world = make_world({.gravity = {0, 0, 0}});
    ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0, 0}, {0.3, 0.3, 0.3}}}, .viscosity = 1, .cell_size = 0.03}));
    const BodyHandle ball = world
                                ->create_body({.shape = world->create_shape(SphereShape{0.012}).value(),
                                               .position = {0.08, 0.15, 0.15},
                                               .linear_velocity = {2, 0, 0},
                                               .mass = {.density = 7850}})
                                .value();
    const double before = world->conserved().linear_momentum.x;
    for (int i = 0; i < 6; ++i) world->step();
    EXPECT_LT(world->linear_velocity(ball).x, 1.8);
    EXPECT_NEAR(world->conserved().linear_momentum.x, before, 0.05 * before);
}

// Creeping motion, G. G. Stokes (1851): the weight less the buoyancy against 6 π μ r v, at any step, in liquids with
// and without a weight of their own.
TEST(FluidSmallBody, BallsSinkAsStokesSaysInLiquidsOfAnyViscosity) {
    Random random(22);
    for (int trial = 0; trial < 16; ++trial) {
        SCOPED_TRACE(trial);
        constexpr double liquid_density = 998, side = 0.48, depth = 0.6;
        const bool has_weight = trial >= 8;
        const double radius = random.between(0.002, 0.01), density = random.between(1500, 8000);
        const double weight =
            4.0 / 3 * pi * radius * radius * radius * (density - (has_weight ? liquid_density : 0)) * gravity;
        // So thick that the Reynolds number stays below 0.1.
        const double least = std::sqrt(weight * liquid_density / (3 * pi * 0.1));
        const double viscosity = std::max(least, std::exp(random.between(std::log(0.3), std::log(100.0))));
        const double expected = weight / (6 * pi * viscosity * radius), rate = trial % 2 == 0 ? 60 : 240;
        auto world = make_world({.time_step = 1 / rate});
        add_tank(*world, {{0, 0, 0}, {side, 0.9, side}});
        ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0, 0}, {side, depth, side}}},
                                         .viscosity = viscosity,
                                         .cell_size = 0.04,
                                         .gravity_factor = has_weight ? 1.0 : 0.0,
                                         .allow_sleep = false}));
        const BodyHandle body = world
                                    ->create_body({.shape = world->create_shape(SphereShape{radius}).value(),
                                                   .position = {side / 2, 0.35, side / 2},
                                                   .mass = {.density = density}})
                                    .value();
        run(*world, 0.5);
        const double start = world->center_of_mass(body).y;
        run(*world, 0.5);
        const double ratio = (start - world->center_of_mass(body).y) / 0.5 / expected;
        RecordProperty("ratio_" + std::to_string(trial), std::to_string(ratio));
        EXPECT_NEAR(ratio, 1, 0.1) << radius << " m, " << viscosity << " Pa s, " << rate << " Hz";
    }
}

}  // namespace
}  // namespace embody::physics
