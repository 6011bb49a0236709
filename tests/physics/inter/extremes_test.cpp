// SPDX-License-Identifier: MIT
// The ends of what bodies may be: heavy and light, small and large, fast, thousands in one place.
#include <gtest/gtest.h>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

struct Floor {
    std::unique_ptr<World> world = make_world();
    Floor() {
        const auto plane = world->create_shape(PlaneShape{}).value();
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = plane}));
    }
    std::uint32_t run(int steps) {
        std::uint32_t limits = 0;
        for (int i = 0; i < steps; ++i) limits |= world->step().limits;
        return limits;
    }
};

bool has(std::uint32_t limits, StepLimit limit) { return (limits & static_cast<std::uint32_t>(limit)) != 0; }

TEST(Extremes, MassesFromAMilligramToAThousandTonsLieOnTheFloor) {
    for (const double mass : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        SCOPED_TRACE(std::to_string(mass) + " kg");
        Floor floor;
        const auto box = floor.world->create_shape(BoxShape{{0.2, 0.1, 0.3}}).value();
        const auto body =
            floor.world->create_body({.shape = box, .position = {0, 0.15, 0}, .mass = {.mass = mass}}).value();
        EXPECT_EQ(floor.run(180), 0u);
        EXPECT_NEAR(floor.world->pose(body).position.y, 0.1, 1e-4);
        EXPECT_EQ(floor.world->sleep_state(body), SleepState::asleep);
    }
}

TEST(Extremes, BoxesFromAMillimetreToAKilometreLieOnTheFloor) {
    for (const double half : {5e-4, 5e-3, 0.5, 50.0, 500.0}) {
        SCOPED_TRACE(std::to_string(2 * half) + " m");
        Floor floor;
        const auto box = floor.world->create_shape(BoxShape{{half, half, half}}).value();
        const MassDefinition mass{.mass = 1000 * half};
        const auto body = floor.world->create_body({.shape = box, .position = {0, half, 0}, .mass = mass}).value();
        const auto on_top =
            floor.world->create_body({.shape = box, .position = {0, 3 * half, 0}, .mass = mass}).value();
        floor.run(300);
        EXPECT_NEAR(floor.world->pose(body).position.y, half, 0.002 * half + 5e-5);
        EXPECT_NEAR(floor.world->pose(on_top).position.y, 3 * half, 0.004 * half + 1e-4);
        EXPECT_EQ(floor.world->sleep_state(on_top), SleepState::asleep);
    }
}

TEST(Extremes, TooFastMotionIsSlowedAndReported) {
    Floor floor;
    const auto ball = floor.world->create_shape(SphereShape{0.1}).value();
    const auto body =
        floor.world->create_body({.shape = ball, .position = {0, 1000, 0}, .mass = {.mass = 1e-6}}).value();
    ASSERT_TRUE(floor.world->apply_impulse(body, {1e15, 0, 0}));
    ASSERT_TRUE(floor.world->apply_angular_impulse(body, {0, 1e15, 0}));
    const std::uint32_t limits = floor.run(3);
    EXPECT_TRUE(has(limits, StepLimit::linear_speed_clamped));
    EXPECT_TRUE(has(limits, StepLimit::angular_speed_clamped));
    EXPECT_FALSE(has(limits, StepLimit::not_finite_body_frozen));
    EXPECT_NEAR(length(floor.world->linear_velocity(body)), 1e4, 1);
    EXPECT_NEAR(length(floor.world->angular_velocity(body)), 2e4, 1);
}

// 4 cm are what a fast fall may leave for a moment, 6 cm are not.
TEST(Extremes, DeepOverlapsAreReported) {
    for (const double depth : {0.04, 0.06}) {
        Floor floor;
        const auto box = floor.world->create_shape(BoxShape{{0.5, 0.5, 0.5}}).value();
        ASSERT_TRUE(floor.world->create_body({.shape = box, .position = {0, 0.5 - depth, 0}}));
        EXPECT_EQ(has(floor.run(1), StepLimit::deep_penetration), depth > 0.05) << depth;
    }
}

TEST(Extremes, ThousandsOfBodiesInOnePointAreSteppedAndReported) {
    Floor floor;
    const auto ball = floor.world->create_shape(SphereShape{0.3}).value();
    constexpr int count = 3000;  // tried with 10,000 as well: 4 s a step, 1 GB
    for (int i = 0; i < count; ++i) ASSERT_TRUE(floor.world->create_body({.shape = ball, .position = {0, 2, 0}}));
    const std::uint32_t limits = floor.run(1);
    EXPECT_TRUE(has(limits, StepLimit::too_many_pairs));
    EXPECT_TRUE(has(limits, StepLimit::deep_penetration));
    EXPECT_LT(floor.world->last_report().pairs, 120000u);
    for (const BodyHandle body : floor.world->bodies()) {
        ASSERT_TRUE(is_finite(floor.world->pose(body)));
        ASSERT_LT(length(floor.world->linear_velocity(body)), 1000);
    }
}

}  // namespace
}  // namespace embody::physics
