// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::constraint {
namespace {

// A hinge pressed against its limit, then let go and pushed off: the limit must not push after it.
TEST(JointLimit, ReleasesABodyThatMovesAwayFromIt) {
    const auto world = make_world({.gravity = {}});
    const auto door = world->create_body({.mass = {.mass = 1, .inertia = Mat3::diagonal({1, 1, 1})}}).value();
    ASSERT_TRUE(world->create_joint({.joint = HingeJoint{.limit = JointLimit{0, 3}}, .body_b = door}));
    ASSERT_TRUE(world->set_force(door, {}, {-5, 0, 0}));
    for (int i = 0; i < 30; ++i) world->step();
    EXPECT_NEAR(world->angular_velocity(door).x, 0, 1e-9);

    ASSERT_TRUE(world->set_force(door, {}, {}));
    ASSERT_TRUE(world->set_velocity(door, {}, {0.5, 0, 0}));
    for (int i = 0; i < 60; ++i) world->step();
    EXPECT_NEAR(world->angular_velocity(door).x, 0.5, 1e-9);
}

}  // namespace
}  // namespace embody::physics::constraint
