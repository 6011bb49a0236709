// SPDX-License-Identifier: MIT
// What is slow but not in balance does not fall asleep.
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

TEST(SleepOnlyInBalance, ABallRollsDownTheGentlestSlope) {
    const auto world = make_world({});
    const double angle = 0.3 * pi / 180, radius = 0.1, seconds = 10;
    add_plane(*world, friction(0.5), angle);
    const Vec3 up{std::sin(angle), std::cos(angle), 0};
    const auto ball = world->create_body({.shape = world->create_shape(SphereShape{radius}).value(),
                                          .position = up * radius,
                                          .material = friction(0.5)});
    ASSERT_TRUE(ball);
    run(*world, seconds);
    const double expected = 5.0 / 7 * gravity * std::sin(angle) * seconds * seconds / 2;
    EXPECT_NEAR(distance(world->pose(ball.value()).position, up * radius), expected, 0.02 * expected);
}

TEST(SleepOnlyInBalance, TheGentlestPushMovesWhatFloatsFreely) {
    const auto world = make_world({.gravity = {}});
    const auto body =
        world->create_body({.shape = world->create_shape(BoxShape{{0.1, 0.1, 0.1}}).value(), .mass = {.mass = 1}});
    ASSERT_TRUE(body);
    const double force = 0.01, seconds = 10;
    for (int i = 0; i < 600; ++i) {
        ASSERT_TRUE(world->apply_force(body.value(), {force, 0, 0}));
        world->step();
    }
    EXPECT_NEAR(world->pose(body.value()).position.x, force * seconds * seconds / 2, 0.01);
}

TEST(SleepOnlyInBalance, ALongPendulumTurnsBack) {
    const auto world = make_world({});
    const double length = 20, amplitude = 0.2 * pi / 180;
    const auto bob = world->create_body({.shape = world->create_shape(SphereShape{0.1}).value(),
                                         .position = {length * std::sin(amplitude), -length * std::cos(amplitude), 0},
                                         .mass = {.mass = 1}});
    ASSERT_TRUE(bob);
    ASSERT_TRUE(
        world->create_joint({.joint = BallJoint{},
                             .body_b = bob.value(),
                             .frame_b = {{-length * std::sin(amplitude), length * std::cos(amplitude), 0}, {}}}));
    const double period = 2 * pi * std::sqrt(length / gravity);
    run(*world, 2.25 * period);
    EXPECT_NEAR(world->pose(bob.value()).position.x, 0, 0.1 * length * amplitude);
    EXPECT_NEAR(world->linear_velocity(bob.value()).x, -std::sqrt(gravity / length) * length * amplitude, 0.003);
}

class BlockOnSlope : public testing::TestWithParam<double> {};

TEST_P(BlockOnSlope, SlidesJustAboveItsFrictionAngle) {
    const auto world = make_world({});
    const double mu = 0.4, angle = std::atan(mu) + GetParam() * pi / 180, half = 0.25, seconds = 5;
    add_plane(*world, friction(mu), angle);
    const Vec3 up{std::sin(angle), std::cos(angle), 0};
    const auto block = world->create_body({.shape = world->create_shape(BoxShape{{half, half, half}}).value(),
                                           .position = up * half,
                                           .rotation = from_axis_angle({0, 0, 1}, -angle),
                                           .material = friction(mu)});
    ASSERT_TRUE(block);
    run(*world, seconds);
    const double expected = gravity * (std::sin(angle) - mu * std::cos(angle)) * seconds * seconds / 2;
    EXPECT_NEAR(distance(world->pose(block.value()).position, up * half), std::max(0.0, expected),
                0.05 * std::fabs(expected) + 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Degrees, BlockOnSlope, testing::Values(-0.1, 0.1, 0.2, 0.3, 1.0));

}  // namespace
}  // namespace embody::physics
