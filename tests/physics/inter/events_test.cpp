// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

struct Floor {
    std::unique_ptr<World> world = make_world();
    ShapeHandle plane = world->create_shape(PlaneShape{}).value();
    ShapeHandle box = world->create_shape(BoxShape{}).value();
    ShapeHandle ball = world->create_shape(SphereShape{0.5}).value();
    BodyHandle ground = world->create_body({.kind = BodyKind::static_body, .shape = plane}).value();
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world->step();
    }
};

TEST(ContactEvents, BeginTellsTheApproachSpeedAndEndFollowsTheBounce) {
    Floor floor;
    const auto ball =
        floor.world
            ->create_body(
                {.shape = floor.ball, .position = {0, 1.5, 0}, .material = {.restitution = 0.8}, .user_data = 42})
            .value();
    int begins = 0, ends = 0;
    for (int i = 0; i < 40; ++i) {
        floor.world->step();
        for (const ContactEvent& event : floor.world->contact_events()) {
            EXPECT_EQ(event.a, floor.ground);
            EXPECT_EQ(event.b, ball);
            EXPECT_EQ(event.user_data_b, 42u);
            if (event.kind == ContactEvent::Kind::begin) {
                ++begins;
                EXPECT_NEAR(event.approach_speed, std::sqrt(2 * 9.81), 0.2);
                EXPECT_NEAR(event.normal.y, 1, 1e-12);
            } else {
                ++ends;
            }
        }
    }
    EXPECT_EQ(begins, 1);
    EXPECT_EQ(ends, 1);
}

TEST(SleepEvents, BodyFallsAsleepOnceAndWakesWhenHit) {
    Floor floor;
    const auto box = floor.world->create_body({.shape = floor.box, .position = {0, 0.5, 0}}).value();
    int slept = 0;
    for (int i = 0; i < 120; ++i) {
        floor.world->step();
        for (const SleepEvent& event : floor.world->sleep_events())
            slept += event.kind == SleepEvent::Kind::fell_asleep;
    }
    EXPECT_EQ(slept, 1);
    EXPECT_EQ(floor.world->sleep_state(box), SleepState::asleep);

    const auto ball = floor.world->create_body({.shape = floor.ball, .position = {0, 3, 0}}).value();
    floor.run(60);
    EXPECT_LT(floor.world->pose(ball).position.y, 2.1);
    EXPECT_NE(floor.world->sleep_state(box), SleepState::asleep);
}

TEST(Contacts, RestingBoxShowsItsWeightOverTheStep) {
    Floor floor;
    const auto box = floor.world->create_body({.shape = floor.box, .position = {0, 0.5, 0}}).value();
    floor.run(20);
    double impulse = 0;
    for (const ContactView& contact : floor.world->contacts()) impulse += contact.impulse.y;
    EXPECT_NEAR(impulse, floor.world->mass(box) * 9.81 / 60, 1e-3 * impulse);
}

TEST(Queries, RayAndDropAndBoxFindTheBody) {
    Floor floor;
    const auto box = floor.world->create_body({.shape = floor.box, .position = {0, 5, 0}}).value();
    const auto hit = floor.world->cast_ray({0, 10, 0}, {0, -3, 0}, 100);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->body, box);
    EXPECT_NEAR(hit->distance, 4.5, 1e-9);
    const auto through = floor.world->cast_ray({0, 10, 0}, {0, -1, 0}, 100, box);
    ASSERT_TRUE(through);
    EXPECT_EQ(through->body, floor.ground);
    EXPECT_FALSE(floor.world->cast_ray({0, 10, 0}, {0, 0, 0}, 100));
    const auto drop = floor.world->drop_distance(box, 100);
    ASSERT_TRUE(drop);
    EXPECT_NEAR(*drop, 4.5, 1e-5);
    EXPECT_FALSE(floor.world->drop_distance(box, 1));
    const auto found = floor.world->overlap_box({{-1, 4, -1}, {1, 6, 1}});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0], box);
}

TEST(Queries, OverlapsAreNotNeighbours) {
    Floor floor;
    const auto box = floor.world->create_body({.shape = floor.box, .position = {0, 5, 0}}).value();
    // Bounds in the broad phase are larger than the bodies.
    EXPECT_TRUE(floor.world->overlap_box({{0.51, 4.6, -0.4}, {0.8, 5.4, 0.4}}).empty());
    EXPECT_FALSE(floor.world->overlaps(floor.box, {{1.01, 5, 0}, {}}));
    EXPECT_FALSE(floor.world->overlaps(floor.box, {{1.0001, 5, 0}, {}}));
    EXPECT_TRUE(floor.world->overlaps(floor.box, {{0.99, 5, 0}, {}}));
    EXPECT_FALSE(floor.world->overlaps(floor.box, {{0.99, 5, 0}, {}}, [&](BodyHandle body) { return body == box; }));
}

// A fall close beside a wall is as long as in the open: it ended after 256 gaps before.
TEST(Queries, AShapeIsCastPastWhatItDoesNotApproach) {
    Floor floor;
    const auto wall = floor.world->create_shape({BoxShape{{0.1, 20, 5}}}).value();
    ASSERT_TRUE(floor.world->create_body({.kind = BodyKind::static_body, .shape = wall, .position = {0, 20, 0}}));
    for (const double gap : {1e-4, 1e-3, 5e-3}) {
        const Transform start{{0.6 + gap, 10, 0}, {}};
        const auto fall = floor.world->cast_shape(floor.box, start, {0, -1, 0}, 100);
        ASSERT_TRUE(fall);
        EXPECT_NEAR(*fall, 9.5, 1e-5);
        const auto aside = floor.world->cast_shape(floor.box, start, {-1, 0, 0}, 100);
        ASSERT_TRUE(aside);
        EXPECT_NEAR(*aside, gap, 1e-6);
        EXPECT_FALSE(floor.world->cast_shape(floor.box, start, {1, 0, 0}, 100));
    }
}

TEST(Wake, RemovingTheFloorWakesWhatStoodOnIt) {
    Floor floor;
    const auto shelf =
        floor.world->create_body({.kind = BodyKind::static_body, .shape = floor.box, .position = {0, 3, 0}}).value();
    const auto box = floor.world->create_body({.shape = floor.box, .position = {0, 4, 0}}).value();
    floor.run(120);
    ASSERT_EQ(floor.world->sleep_state(box), SleepState::asleep);
    ASSERT_TRUE(floor.world->destroy_body(shelf));
    floor.run(120);
    EXPECT_NEAR(floor.world->pose(box).position.y, 0.5, 0.01);
}

TEST(Tunnelling, FastBallDoesNotPassThroughAThinWall) {
    Floor floor;
    const auto slab = floor.world->create_shape(BoxShape{{0.02, 2, 2}}).value();
    ASSERT_TRUE(floor.world->create_body({.kind = BodyKind::static_body, .shape = slab, .position = {5, 2, 0}}));
    const auto ball = floor.world->create_shape(SphereShape{0.05}).value();
    const auto bullet =
        floor.world->create_body({.shape = ball, .position = {0, 2, 0}, .linear_velocity = {300, 0, 0}}).value();
    floor.run(30);
    EXPECT_LT(floor.world->pose(bullet).position.x, 5);
}

TEST(Joints, ReactionCarriesTheWeightAndLimitAndMotorHold) {
    Floor floor;
    WorldSettings settings;
    settings.gravity = {0, -10, 0};
    ASSERT_TRUE(floor.world->set_settings(settings));
    const auto bob =
        floor.world->create_body({.shape = floor.ball, .position = {0, 5, 0}, .mass = {.mass = 2}}).value();
    const auto rope =
        floor.world
            ->create_joint(
                {.joint = BallJoint{}, .body_b = bob, .frame_a = {{0, 7, 0}, {}}, .frame_b = {{0, 2, 0}, {}}})
            .value();
    floor.run(20);
    EXPECT_NEAR(floor.world->joint_reaction(rope).force.y, 20, 1e-6);

    // A slider that falls to its lower limit, and a hinge that its motor turns.
    const auto cart =
        floor.world->create_body({.shape = floor.ball, .position = {10, 5, 0}, .mass = {.mass = 1}}).value();
    const Quat up = from_axis_angle({0, 0, 1}, 1.5707963267948966);
    const auto slider = floor.world
                            ->create_joint({.joint = SliderJoint{.limit = JointLimit{-1, 1}},
                                            .body_b = cart,
                                            .frame_a = {{10, 5, 0}, up},
                                            .frame_b = {{}, up}})
                            .value();
    const auto wheel =
        floor.world->create_body({.shape = floor.ball, .position = {20, 5, 0}, .mass = {.mass = 1}}).value();
    ASSERT_TRUE(floor.world->create_joint({.joint = HingeJoint{.motor = JointMotor{3, 100}},
                                           .body_b = wheel,
                                           .frame_a = {{20, 5, 0}, {}},
                                           .frame_b = {}}));
    floor.run(120);
    EXPECT_NEAR(floor.world->joint_coordinate(slider), -1, 1e-3);
    EXPECT_NEAR(floor.world->pose(cart).position.y, 4, 1e-3);
    EXPECT_NEAR(floor.world->angular_velocity(wheel).x, 3, 1e-6);
}

}  // namespace
}  // namespace embody::physics
