// SPDX-License-Identifier: MIT
// Chains whose passes come to no end in a substep must not swing up from one to the next.
#include <gtest/gtest.h>

#include <cmath>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::constraint {
namespace {

// Five rods hung on each other; each has a velocity that the joints forbid at least in part.
double greatest_energy_gain(const decltype(JointDefinition::joint)& kind, int count) {
    const auto world = make_world({.gravity = {}});
    const auto rod = world->create_shape(CapsuleShape{0.1, 0.3}).value();
    BodyHandle last;
    for (int i = 0; i < count; ++i) {
        const Vec3 place{0, -0.9 * i, 0};
        const auto body = world
                              ->create_body({.shape = rod,
                                             .position = place,
                                             .linear_velocity = {1.2 * i / (count - 1), 0, 0.8 * i / (count - 1)}})
                              .value();
        JointDefinition joint{.joint = kind, .body_a = last, .body_b = body, .frame_b = {{0, 0.45, 0}, {}}};
        joint.frame_a = {i == 0 ? place + Vec3{0, 0.45, 0} : Vec3{0, -0.45, 0}, {}};
        EXPECT_TRUE(world->create_joint(joint));
        last = body;
    }
    const double start = world->conserved().kinetic_energy;
    double most = 0;
    for (int i = 0; i < 120; ++i) {
        world->step();
        most = std::max(most, world->conserved().kinetic_energy);
    }
    EXPECT_EQ(world->last_report().limits, 0u);
    return most / start;
}

TEST(JointChain, KeepsItsEnergyOrLosesIt) {
    for (const int count : {3, 5, 12, 30}) {
        EXPECT_LE(greatest_energy_gain(FixedJoint{}, count), 1.01) << count;
        EXPECT_LE(greatest_energy_gain(BallJoint{}, count), 1.01) << count;
        EXPECT_LE(greatest_energy_gain(HingeJoint{.limit = JointLimit{-0.4, 0.5}}, count), 1.01) << count;
        EXPECT_LE(greatest_energy_gain(SliderJoint{.limit = JointLimit{-0.2, 0.2}}, count), 1.01) << count;
    }
}

// What rounding stirs in a chain of more links than are solved at once must not grow from one substep to the next.
TEST(JointChain, TooLongForOneSolveStaysWhereItIs) {
    const auto world = make_world({.gravity = {}});
    const auto ball = world->create_shape(SphereShape{0.05}).value();
    const Vec3 end{0.1, 0, 0};
    BodyHandle last;
    double mass = 0;
    for (int i = 0; i < 260; ++i) {
        const auto link = world->create_body({.shape = ball, .position = end * (2 * i), .allow_sleep = false}).value();
        mass += world->mass(link);
        if (i > 0) {
            ASSERT_TRUE(world->create_joint(
                {.joint = BallJoint{}, .body_a = last, .body_b = link, .frame_a = {end, {}}, .frame_b = {-end, {}}}));
        }
        last = link;
    }
    for (int i = 0; i < 60; ++i) world->step();
    EXPECT_LT(std::sqrt(2 * world->conserved().kinetic_energy / mass), 5e-3);
}

}  // namespace
}  // namespace embody::physics::constraint
