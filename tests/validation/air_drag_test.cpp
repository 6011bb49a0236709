// SPDX-License-Identifier: MIT
// Drag of the air on rigid bodies.
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

BodyHandle add_ball(World& world, double radius, double mass, double drag_area, Vec3 position) {
    BodyDefinition ball{.shape = world.create_shape(SphereShape{radius}).value(), .position = position};
    ball.mass.mass = mass;
    ball.drag_area = drag_area;
    return world.create_body(ball).value();
}

TEST(AirDrag, ASkydiverComesToTerminalSpeed) {
    const auto reference = reference_case("terminal_air");
    const auto& setup = reference["setup"];
    WorldSettings settings;
    settings.air_density = setup["rho"];
    const auto world = make_world(settings);
    const BodyHandle diver = add_ball(*world, 0.3, setup["m"], setup["CdA"], {0, 5000, 0});
    const auto speed = [&] { return length(world->linear_velocity(diver)); };
    const auto& expected = reference["expected"];
    const double tolerance = reference["tolerance"]["rel"];
    run(*world, 5);
    EXPECT_NEAR(speed(), expected["v_5s"], tolerance * static_cast<double>(expected["v_5s"]));
    run(*world, 40);
    EXPECT_NEAR(speed(), expected["vt"], tolerance * static_cast<double>(expected["vt"]));
}

TEST(AirDrag, WindCarriesAlongWhatHangsInTheAir) {
    WorldSettings settings;
    settings.gravity = {};
    settings.wind = {4, 0, -3};
    const auto world = make_world(settings);
    const BodyHandle light = add_ball(*world, 0.1, 1e-3, 0.05, {}), without = add_ball(*world, 0.1, 1, 0, {1, 0, 0});
    run(*world, 2);
    EXPECT_LT(length(world->linear_velocity(light) - settings.wind), 0.05 * length(settings.wind));
    EXPECT_EQ(world->linear_velocity(without), Vec3{});
}

TEST(AirDrag, ASleeperWakesWhenTheWindRises) {
    WorldSettings settings;
    const auto world = make_world(settings);
    add_plane(*world, friction(0.5));
    BodyDefinition definition{.shape = world->create_shape(BoxShape{{0.2, 0.2, 0.2}}).value(), .position = {0, 0.2, 0}};
    definition.drag_area = 0.2;
    definition.mass.mass = 0.5;
    const BodyHandle light = world->create_body(definition).value();
    definition.position.x = 2;
    definition.mass.mass = 500;
    const BodyHandle heavy = world->create_body(definition).value();
    run(*world, 3);
    ASSERT_EQ(world->sleep_state(light), SleepState::asleep);
    // 1/2 1.2 kg/m3 0.2 m2 (9 m/s)2 = 9.7 N, four times what friction holds of the light one.
    settings.wind = {9, 0, 0};
    ASSERT_TRUE(world->set_settings(settings).ok());
    run(*world, 1);
    EXPECT_GT(world->pose(light).position.x, 0.5);
    EXPECT_NEAR(world->pose(heavy).position.x, 2, 1e-4);
}

}  // namespace
}  // namespace embody::physics
