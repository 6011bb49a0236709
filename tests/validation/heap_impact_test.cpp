// SPDX-License-Identifier: MIT
//
// Collisions with bodies that others carry take a cheaper way than free ones (docs/physics/impact.md).
#include <gtest/gtest.h>

#include <algorithm>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

class CollapsingPile : public testing::TestWithParam<double> {};

// Balls and boxes from up to 10 m: hundreds of impacts a step.
TEST_P(CollapsingPile, NeverGainsEnergy) {
    const auto world = make_world({});
    const Material material{.restitution = GetParam()};
    add_plane(*world, material);
    const ShapeHandle shapes[] = {world->create_shape(SphereShape{0.25}).value(),
                                  world->create_shape(BoxShape{{0.25, 0.25, 0.25}}).value()};
    Random random(4);
    for (int i = 0; i < 400; ++i) {
        const Vec3 place{0.8 * (i % 5) + random.between(-0.1, 0.1), 0.6 + 0.6 * (i / 25),
                         0.8 * (i / 5 % 5) + random.between(-0.1, 0.1)};
        const Quat rotation = from_axis_angle(normalized(Vec3{random.between(-1, 1), 1, 0}), random.between(0, 3));
        EXPECT_TRUE(world->create_body(
            {.shape = shapes[i % 2], .position = place, .rotation = rotation, .material = material}));
    }
    const double start = energy(*world);
    double least = start;
    for (int step = 0; step < 150; ++step) {
        world->step();
        const double now = energy(*world);
        ASSERT_LE(now, least + 1e-3 * start) << "step " << step;
        least = std::min(least, now);
    }
    EXPECT_LT(least, 0.6 * start);
}

INSTANTIATE_TEST_SUITE_P(Restitution, CollapsingPile, testing::Values(0.0, 0.3, 0.8),
                         [](const auto& test) { return "Percent" + std::to_string(std::lround(100 * test.param)); });

// Seen from the start of a step a cube beside the ball's path lies ahead of it. By the time the ball gets there it does
// not: the region of the start of the step must not stop it.
TEST(PileImpact, BallThatPassesTheEdgeOfACarriedCubeIsNotHeldUp) {
    const auto world = make_world({});
    add_plane(*world, {});
    const auto cube = world->create_shape(BoxShape{{0.5, 0.5, 0.5}}).value();
    const auto carried = world->create_body({.shape = cube, .position = {0, 0.5, 0}}).value();
    run(*world, 0.2);
    const auto shape = world->create_shape(SphereShape{0.3}).value();
    for (int phase = 0; phase < 8; ++phase) {
        // Each time it meets the cube at another part of a step.
        const auto ball = world
                              ->create_body({.shape = shape,
                                             .position = {0.802, 0.6, -3 - 0.04 * phase},
                                             .linear_velocity = {0, 0, 20},
                                             .gravity_factor = 0})
                              .value();
        run(*world, 0.4);
        EXPECT_EQ(world->linear_velocity(ball), (Vec3{0, 0, 20})) << phase;
        EXPECT_TRUE(world->destroy_body(ball));
    }
    EXPECT_LT(length(world->linear_velocity(carried)), 1e-6);
}

}  // namespace
}  // namespace embody::physics
