// SPDX-License-Identifier: MIT
// Pairs that are apart are left alone for as long as their bodies' ways are shorter than the gap: whatever closes the
// gap must be noticed.
#include <gtest/gtest.h>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

// Without gravity and sleep, a ball of 0.1 m at rest in the origin.
struct Room {
    std::unique_ptr<World> world = make_world({.gravity = {}, .sleeping = false});
    BodyHandle ball = world->create_body({.shape = world->create_shape(SphereShape{0.1}).value()}).value();

    void run(int steps) {
        for (int i = 0; i < steps; ++i) world->step();
    }
    BodyHandle add_box(Vec3 half_extents, BodyDefinition body) {
        body.shape = world->create_shape(BoxShape{half_extents}).value();
        return world->create_body(body).value();
    }
};

TEST(PairsApart, ARodThatTurnsInItsPlaceMeetsABall) {
    Room room;
    room.add_box({0.5, 0.05, 0.05}, {.position = {0.3, 0, 0.35}, .angular_velocity = {0, 1, 0}});
    room.run(10);
    EXPECT_TRUE(room.world->contacts().empty());
    room.run(110);
    EXPECT_GT(length(room.world->linear_velocity(room.ball)), 0.05);
}

TEST(PairsApart, AWallPutBesideABallTouchesIt) {
    Room room;
    const BodyHandle wall = room.add_box({0.1, 1, 1}, {.kind = BodyKind::static_body, .position = {0.23, 0, 0}});
    room.run(10);
    EXPECT_TRUE(room.world->contacts().empty());
    ASSERT_TRUE(room.world->set_pose(wall, {{0.199, 0, 0}, {}}));
    room.run(1);
    EXPECT_EQ(room.world->contacts().size(), 1u);
}

TEST(PairsApart, AKinematicWallThatMovesPushesABall) {
    Room room;
    const BodyHandle wall = room.add_box({0.1, 1, 1}, {.kind = BodyKind::kinematic_body, .position = {0.24, 0, 0}});
    room.run(10);
    EXPECT_TRUE(room.world->contacts().empty());
    ASSERT_TRUE(room.world->set_velocity(wall, {-0.1, 0, 0}, {}));
    room.run(60);
    EXPECT_NEAR(room.world->linear_velocity(room.ball).x, -0.1, 0.01);
}

TEST(PairsApart, ALargerBodyInTheSamePlaceTouchesABall) {
    Room room;
    const BodyHandle wall = room.add_box({0.1, 1, 1}, {.kind = BodyKind::static_body, .position = {0.23, 0, 0}});
    room.run(10);
    ASSERT_TRUE(room.world->destroy_body(wall));
    room.add_box({0.131, 1, 1}, {.kind = BodyKind::static_body, .position = {0.23, 0, 0}});
    room.run(1);
    EXPECT_EQ(room.world->contacts().size(), 1u);
}

}  // namespace
}  // namespace embody::physics::stages
