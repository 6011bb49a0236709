// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

// A floor and a column of cubes of side `side`, each `gap` above the one below.
struct Column {
    std::unique_ptr<World> world;
    std::vector<BodyHandle> cubes;
    double side;

    Column(int count, double cube_side, double gap, double restitution = 0, const WorldSettings& settings = {})
        : world(make_world(settings)), side(cube_side) {
        const auto plane = world->create_shape(PlaneShape{}).value();
        const auto box = world->create_shape(BoxShape{Vec3{side, side, side} * 0.5}).value();
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = plane}));
        for (int i = 0; i < count; ++i) {
            BodyDefinition cube{.shape = box, .position = {0, side / 2 + gap + i * (side + gap), 0}};
            cube.material.restitution = restitution;
            cubes.push_back(world->create_body(cube).value());
        }
    }

    void run(double seconds) {
        const int steps = static_cast<int>(std::lround(seconds / world->settings().time_step));
        for (int i = 0; i < steps; ++i) world->step();
    }
    double error_of_height(int i) const {
        return world->pose(cubes[static_cast<std::size_t>(i)]).position.y - (side / 2 + i * side);
    }
    double sideways(int i) const {
        const Vec3 p = world->pose(cubes[static_cast<std::size_t>(i)]).position;
        return std::hypot(p.x, p.z);
    }
    bool all_asleep() const {
        for (const BodyHandle cube : cubes) {
            if (world->sleep_state(cube) != SleepState::asleep) return false;
        }
        return true;
    }
};

TEST(Stack, TenCubesOfOneMetreStandAndFallAsleep) {
    Column column(10, 1, 0);
    column.run(3);
    EXPECT_TRUE(column.all_asleep());
    for (int i = 0; i < 10; ++i) {
        EXPECT_NEAR(column.error_of_height(i), 0, 3e-3) << i;
        EXPECT_LT(column.sideways(i), 2e-3) << i;
    }
}

TEST(Stack, TenCubesOfTenCentimetresStandAndFallAsleep) {
    Column column(10, 0.1, 0);
    column.run(3);
    EXPECT_TRUE(column.all_asleep());
    for (int i = 0; i < 10; ++i) {
        EXPECT_NEAR(column.error_of_height(i), 0, 3e-3) << i;
        EXPECT_LT(column.sideways(i), 2e-3) << i;
    }
}

TEST(Stack, CubesDroppedOnEachOtherSettleAsColumn) {
    Column column(10, 1, 0.05);
    column.run(6);
    EXPECT_TRUE(column.all_asleep());
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(column.error_of_height(i), 0, 5e-3) << i;
}

TEST(Stack, CubesAsleepWakeWhenTheLowestIsRemoved) {
    Column column(4, 1, 0);
    column.run(3);
    ASSERT_TRUE(column.all_asleep());
    ASSERT_TRUE(column.world->destroy_body(column.cubes[0]));
    column.run(3);
    EXPECT_NEAR(column.world->pose(column.cubes[3]).position.y, 2.5, 0.01);
}

}  // namespace
}  // namespace embody::physics::stages
