// SPDX-License-Identifier: MIT
// Sheets and ropes that nothing holds fall as a point does, from the velocity that they are given for an instant on;
// what is held bears its weight, however often it is given a velocity.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

WorldSettings random_steps(Random& random) {
    WorldSettings settings;
    settings.air_density = 0;
    settings.time_step = random.between(1.0 / 240, 1.0 / 50);
    settings.deformable_substeps = 1 + static_cast<int>(random.below(4));
    return settings;
}

DeformableDefinition random_thin(Random& random, bool is_sheet) {
    DeformableDefinition thin = is_sheet ? cloth_rectangle(random.between(0.2, 0.5), random.between(0.2, 0.5), 0.06,
                                                           {.area_density = random.between(0.1, 5),
                                                            .stretch_stiffness = random.between(300, 5000),
                                                            .rayleigh_damping = random.between(0, 0.05)})
                                         : rope_between({-0.2, 0, 0}, {0.2, 0, 0}, random.between(0.02, 0.1),
                                                        {.linear_density = random.between(0.05, 5),
                                                         .axial_stiffness = random.between(1e3, 1e5),
                                                         .rayleigh_damping = random.between(0, 0.05)});
    thin.pose.rotation = random_rotation(random);
    thin.linear_velocity = random_vector(random, 5);
    return thin;
}

/// Gives a deformable's nodes the velocities that they have and `added`, m/s.
void give_velocity(World& world, DeformableHandle handle, Vec3 added) {
    const auto positions = world.node_positions(handle), before = world.node_velocities(handle);
    std::vector<Vec3> velocities(before.begin(), before.end());
    for (Vec3& velocity : velocities) velocity += added;
    ASSERT_TRUE(world.set_nodes(handle, std::vector<Vec3>(positions.begin(), positions.end()), velocities));
}

// At first and after each push in flight; also where the steps become longer or shorter.
TEST(ThinFall, IsThatOfAPoint) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        WorldSettings settings = random_steps(random);
        const auto world = make_world(settings);
        DeformableDefinition thin = random_thin(random, seed % 2 == 0);
        thin.angular_velocity = random_vector(random, 3);
        const DeformableHandle handle = world->create_deformable(thin).value();
        Vec3 center = world->center_of_mass(handle), velocity = thin.linear_velocity;
        for (int part = 0; part < 4; ++part) {
            const int steps = 1 + static_cast<int>(random.below(20));
            for (int i = 0; i < steps; ++i) world->step();
            const double time = steps * settings.time_step;
            center += time * velocity + time * time / 2 * settings.gravity;
            velocity += time * settings.gravity;
            EXPECT_LT(length(world->center_of_mass(handle) - center), 1e-6) << seed << " " << part;
            if (part % 2 == 0) {
                const Vec3 push = random_vector(random, 5);
                give_velocity(*world, handle, push);
                velocity += push;
            } else {
                settings.time_step = random_steps(random).time_step;
                ASSERT_TRUE(world->set_settings(settings));
            }
        }
    }
}

TEST(ThinFall, KeepsTheSpinThatItWasGiven) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        const auto world = make_world(random_steps(random));
        DeformableDefinition thin = random_thin(random, seed % 2 == 0);
        thin.angular_velocity = random_vector(random, 5);
        const DeformableHandle handle = world->create_deformable(thin).value();
        const auto angular_momentum = [&] {
            const Conserved now = world->conserved();
            return now.angular_momentum - cross(world->center_of_mass(handle), now.linear_momentum);
        };
        const Vec3 first = angular_momentum();
        for (int i = 0; i < 10; ++i) world->step();
        EXPECT_LT(length(angular_momentum() - first), 0.03 * length(first)) << seed;
    }
}

TEST(ThinFall, WhatHangsKeepsItsWeightWhenItIsGivenVelocities) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        const bool is_sheet = seed % 2 == 0;
        const auto world = make_world(random_steps(random));
        DeformableDefinition thin =
            is_sheet ? cloth_rectangle(
                           0.4, 0.4, 0.05,
                           {.area_density = random.between(1, 5), .stretch_stiffness = 300, .rayleigh_damping = 0.1})
                     : rope_between(
                           {0, 0, 0}, {0, -1, 0}, 0.05,
                           {.linear_density = random.between(0.5, 2), .axial_stiffness = 100, .rayleigh_damping = 0.1});
        thin.pinned = {0};
        if (is_sheet) {
            // By one side, below which the other one is.
            thin.pose.rotation = from_axis_angle({1, 0, 0}, 1.5707963);
            thin.pinned.clear();
            for (std::uint32_t i = 0; i < thin.nodes.size(); ++i)
                if (thin.nodes[i].z < -0.199) thin.pinned.push_back(i);
        }
        const DeformableHandle handle = world->create_deformable(thin).value();
        run(*world, 10);
        const Vec3 hung = world->center_of_mass(handle);
        const auto span = world->node_positions(handle);
        const std::vector<Vec3> places(span.begin(), span.end());
        for (int i = 0; i < 60; ++i) {
            give_velocity(*world, handle, {});
            world->step();
        }
        EXPECT_LT(length(world->center_of_mass(handle) - hung), 2e-4) << seed;
        // Another one in its form goes on hanging as it is.
        const auto other = make_world(world->settings());
        const DeformableHandle copy = other->create_deformable(thin).value();
        ASSERT_TRUE(other->set_nodes(copy, places, std::vector<Vec3>(places.size())));
        double farthest = 0;
        for (int i = 0; i < 30; ++i) {
            other->step();
            farthest = std::max(farthest, length(other->center_of_mass(copy) - hung));
        }
        EXPECT_LT(farthest, 2e-4) << seed;
    }
}

}  // namespace
}  // namespace embody::physics
