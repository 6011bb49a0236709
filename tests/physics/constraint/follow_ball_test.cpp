// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/constraint/contact/contact.h"

namespace embody::physics::constraint {
namespace {

constexpr double radius = 0.3, half_height = 0.5;

std::vector<Manifold> ball_on_box(Vec3 ball) {
    const auto box = CollisionShape::create(BoxShape{{1, half_height, 1}}).value();
    const auto sphere = CollisionShape::create(SphereShape{radius}).value();
    std::vector<Manifold> manifolds;
    collide(*box, {}, *sphere, {ball, {}}, 0.01, manifolds);
    return manifolds;
}

// A ball on a box moves along the face and off it, and spins: the contact must be the one that would be found anew.
TEST(FollowBall, ContactOverAFaceIsThatOfANewComparison) {
    std::vector<BodyState> bodies(2);
    bodies[1].center = {0.2, half_height + radius - 1e-3, -0.1};
    const std::vector<Manifold> before = ball_on_box(bodies[1].center);
    ASSERT_EQ(before.size(), 1u);
    EXPECT_TRUE(before[0].is_whole);
    Contact followed = make_contact(0, 1, before[0], bodies);

    const Vec3 displacement{2e-3, 5e-4, -1e-3};
    bodies[1].center += displacement;
    follow_bodies(followed, {.shift = to_vec3f(displacement),
                             .axes = {to_vec3f({1, 0, 0}), to_vec3f({0, 1, 0}), to_vec3f({0, 0, 1})},
                             .apart = to_vec3f(bodies[1].center),
                             .spin_b = to_vec3f({1, 2, 3}),
                             .has_ball = true});
    const Contact found = make_contact(0, 1, ball_on_box(bodies[1].center).at(0), bodies);
    const ContactPoint &point = followed.points[0], &expected = found.points[0];
    EXPECT_NEAR(point.separation, expected.separation, 1e-7);
    EXPECT_LT(distance(Vec3(point.arm_a), Vec3(expected.arm_a)), 1e-7);
    EXPECT_LT(distance(Vec3(point.arm_b), Vec3(expected.arm_b)), 1e-7);
    EXPECT_LT(distance(Vec3(followed.normal), Vec3(found.normal)), 1e-7);
}

// Nearer to a side of the face than the way it is kept for, or over an edge, a ball must be compared again sooner.
TEST(FollowBall, ContactIsWholeOnlyWellWithinAFace) {
    const double height = half_height + radius;
    EXPECT_TRUE(ball_on_box({1 - 1.1 * Manifold::whole_travel, height, 0}).at(0).is_whole);
    EXPECT_FALSE(ball_on_box({1 - 0.9 * Manifold::whole_travel, height, 0}).at(0).is_whole);
    EXPECT_FALSE(ball_on_box({1.1, height - 0.02, 0}).at(0).is_whole);
}

TEST(FollowBall, ContactOverAHullsFaceIsWholeOnlyWellWithinIt) {
    // A pyramid's base, seen from below.
    const auto hull = CollisionShape::create(HullShape{{{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {0, 1, 0}}});
    const auto sphere = CollisionShape::create(SphereShape{radius}).value();
    const auto is_whole = [&](double x) {
        std::vector<Manifold> manifolds;
        collide(**hull, {}, *sphere, {{x, -radius - 1e-3, 0.1}, {}}, 0.01, manifolds);
        return manifolds.at(0).is_whole;
    };
    EXPECT_TRUE(is_whole(0));
    EXPECT_TRUE(is_whole(1 - 1.1 * Manifold::whole_travel));
    EXPECT_FALSE(is_whole(1 - 0.9 * Manifold::whole_travel));
}

}  // namespace
}  // namespace embody::physics::constraint
