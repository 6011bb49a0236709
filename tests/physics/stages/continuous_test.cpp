// SPDX-License-Identifier: MIT
// What is faster than it is thick passes through nothing, and what only slides or rolls fast is not held up.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

std::unique_ptr<World> world_of_gravity(Vec3 gravity) { return make_world({.gravity = gravity}); }

BodyHandle add(World& world, const ShapeDefinition& shape, BodyDefinition body) {
    body.shape = world.create_shape(shape).value();
    return world.create_body(body).value();
}

constexpr Material smooth{.friction_static = 0, .friction_dynamic = 0};
const ShapeDefinition small_ball = SphereShape{0.005};
const ShapeDefinition thin_plate = BoxShape{{0.0005, 0.25, 0.25}};

// At 60 Hz it flies 5 m a step; the plate is a five-thousandth of that.
TEST(Continuous, a_ball_of_1_cm_at_300_m_s_does_not_pass_a_plate_of_1_mm) {
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE("start " + std::to_string(i));
        auto world = world_of_gravity({});
        add(*world, thin_plate, {.kind = BodyKind::static_body});
        const auto ball =
            add(*world, small_ball, {.position = {-7 + 0.13 * i, 0.01, 0.02}, .linear_velocity = {300, 0, 0}});
        for (int step = 0; step < 5; ++step) {
            world->step();
            ASSERT_LT(world->pose(ball).position.x, 0) << "step " << step;
        }
        EXPECT_NEAR(world->linear_velocity(ball).x, 0, 1e-3);
    }
}

TEST(Continuous, a_ball_at_300_m_s_pushes_a_loose_plate_and_keeps_the_momentum) {
    for (int i = 0; i < 20; ++i) {
        SCOPED_TRACE("start " + std::to_string(i));
        auto world = world_of_gravity({});
        const auto plate = add(*world, thin_plate, {.mass = {.density = 7800}, .material = smooth});
        const auto ball = add(*world, small_ball,
                              {.position = {-7 + 0.27 * i, 0, 0},
                               .linear_velocity = {300, 0, 0},
                               .mass = {.density = 7800},
                               .material = smooth});
        const double momentum = world->mass(ball) * 300;
        for (int step = 0; step < 6; ++step) {
            world->step();
            ASSERT_LT(world->pose(ball).position.x, world->pose(plate).position.x) << "step " << step;
            EXPECT_NEAR(world->conserved().linear_momentum.x, momentum, 1e-9 * momentum);
        }
        // Without a bounce both go on together.
        const double together = momentum / (world->mass(ball) + world->mass(plate));
        EXPECT_NEAR(world->linear_velocity(plate).x, together, 0.01 * together);
        EXPECT_NEAR(world->linear_velocity(ball).x, together, 0.01 * together);
    }
}

TEST(Continuous, two_bullets_toward_each_other_meet) {
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE("start " + std::to_string(i));
        auto world = world_of_gravity({});
        const auto left = add(*world, small_ball, {.position = {-6 + 0.1 * i, 0, 0}, .linear_velocity = {300, 0, 0}});
        const auto right = add(*world, small_ball, {.position = {6, 0, 0}, .linear_velocity = {-200, 0, 0}});
        const double momentum = world->conserved().linear_momentum.x;
        for (int step = 0; step < 6; ++step) {
            world->step();
            ASSERT_LT(world->pose(left).position.x, world->pose(right).position.x) << "step " << step;
            EXPECT_NEAR(world->conserved().linear_momentum.x, momentum, 1e-9);
        }
        EXPECT_NEAR(world->linear_velocity(left).x, 50, 0.5);
        EXPECT_NEAR(world->linear_velocity(right).x, 50, 0.5);
    }
}

// Bullets that fly behind each other or cross at different times do not disturb each other.
TEST(Continuous, bullets_that_do_not_meet_fly_on) {
    auto world = world_of_gravity({});
    const auto first = add(*world, small_ball, {.position = {0, 0, 0}, .linear_velocity = {300, 0, 0}});
    const auto behind = add(*world, small_ball, {.position = {-0.1, 0, 0}, .linear_velocity = {300, 0, 0}});
    const auto across = add(*world, small_ball, {.position = {2, -1, 0}, .linear_velocity = {0, 300, 0}});
    for (int step = 0; step < 6; ++step) world->step();
    EXPECT_NEAR(world->pose(first).position.x, 30, 1e-9);
    EXPECT_NEAR(world->pose(behind).position.x, 29.9, 1e-9);
    EXPECT_NEAR(world->pose(across).position.y, 29, 1e-9);
}

// A radian a step, edge on towards a plate of 1 mm: above it, its right half never gets below.
TEST(Continuous, a_spinning_rod_does_not_pass_a_thin_wall) {
    for (int i = 0; i < 20; ++i) {
        SCOPED_TRACE("start " + std::to_string(i));
        auto world = world_of_gravity({});
        const Vec3 at{0.7, 0, 0};
        add(*world, BoxShape{{0.2, 0.0005, 0.3}}, {.kind = BodyKind::static_body, .position = at});
        const auto rod = add(*world, BoxShape{{1, 0.01, 0.01}},
                             {.rotation = from_axis_angle({0, 0, 1}, 0.3 + 0.04 * i), .angular_velocity = {0, 0, -60}});
        const double energy = world->conserved().kinetic_energy;
        for (int step = 0; step < 12; ++step) {
            world->step();
            const Transform pose = world->pose(rod);
            const Vec3 along = rotate(pose.rotation, {1, 0, 0});
            if (std::fabs(along.x) < 0.75) continue;
            ASSERT_GT(pose.position.y + along.y / along.x * (at.x - pose.position.x), 0) << "step " << step;
        }
        EXPECT_GT(world->linear_velocity(rod).y, 1);
        EXPECT_LE(world->conserved().kinetic_energy, energy * (1 + 1e-3));
    }
}

/// A floor of 60 x 4 squares with a wall at its end, all one mesh.
MeshShape floor_with_wall(bool has_wall) {
    MeshShape mesh;
    constexpr int length = 60, width = 4;
    for (int x = 0; x <= length; ++x) {
        for (int z = 0; z <= width; ++z) mesh.positions.push_back(to_vec3f({1.0 * x, 0, z - 2.0}));
    }
    const auto at = [](int x, int z) { return static_cast<std::uint32_t>(x * (width + 1) + z); };
    for (int x = 0; x < length; ++x) {
        for (int z = 0; z < width; ++z) {
            mesh.triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z + 1)});
            mesh.triangles.push_back({at(x, z), at(x + 1, z + 1), at(x + 1, z)});
        }
    }
    if (!has_wall) return mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double y : {0.0, 3.0}) {
        for (const double z : {-2.0, 2.0}) mesh.positions.push_back(to_vec3f({40, y, z}));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 2, first + 1, first + 3});
    return mesh;
}

TEST(Continuous, a_fast_slide_over_triangles_is_not_held_up_and_ends_at_a_wall_of_the_same_mesh) {
    for (const bool has_wall : {false, true}) {
        auto world = world_of_gravity({0, -9.81, 0});
        add(*world, floor_with_wall(has_wall), {.kind = BodyKind::static_body, .material = smooth});
        const auto box = add(*world, BoxShape{{0.1, 0.1, 0.1}},
                             {.position = {2, 0.1, 0.13}, .linear_velocity = {60, 0, 0}, .material = smooth});
        for (int step = 0; step < 48; ++step) world->step();
        const Vec3 end = world->pose(box).position;
        EXPECT_NEAR(end.y, 0.1, 1e-3);
        if (has_wall) {
            EXPECT_LT(end.x, 40);
            EXPECT_GT(end.x, 39.5);
        } else {
            EXPECT_NEAR(end.x, 50, 1e-3);
        }
    }
}

TEST(Continuous, a_wheel_rolls_on_over_triangles) {
    auto world = world_of_gravity({0, -9.81, 0});
    add(*world, floor_with_wall(false), {.kind = BodyKind::static_body});
    // Its axis lies along Z; without slip.
    const auto wheel = add(*world, CylinderShape{0.3, 0.05},
                           {.position = {2, 0.3, 0.13},
                            .rotation = from_axis_angle({1, 0, 0}, 1.5707963267948966),
                            .linear_velocity = {24, 0, 0},
                            .angular_velocity = {0, 0, -80}});
    for (int step = 0; step < 120; ++step) world->step();
    EXPECT_NEAR(world->pose(wheel).position.x, 50, 0.5);
    EXPECT_NEAR(world->linear_velocity(wheel).x, 24, 0.3);
}

/// Random smooth balls that fly at each other, at a mesh and at a plate, and turn.
std::unique_ptr<World> swarm(std::uint64_t seed, int workers) {
    auto world = make_world({.gravity = {0, -9.81, 0}, .sleeping = false, .workers = workers});
    add(*world, floor_with_wall(true), {.kind = BodyKind::static_body, .material = smooth});
    add(*world, thin_plate, {.kind = BodyKind::static_body, .position = {10, 0.25, 0}, .material = smooth});
    Random random(seed);
    const auto random_vector = [&] {
        return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    };
    for (int i = 0; i < 200; ++i) {
        const Vec3 place{9.2 + 0.08 * (i % 20), 0.1 + 0.08 * (i / 20 % 5), -0.04 + 0.08 * (i / 100)};
        add(*world, SphereShape{random.between(0.005, 0.03)},
            {.position = place,
             .linear_velocity = random.between(0, 60) * random_vector(),
             .angular_velocity = 200 * random_vector(),
             .material = smooth});
    }
    return world;
}

TEST(Continuous, what_meets_does_not_depend_on_the_workers) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        auto one = swarm(seed, 1), three = swarm(seed, 3);
        for (int step = 0; step < 20; ++step) {
            one->step();
            three->step();
            ASSERT_EQ(one->state_hash(), three->state_hash()) << "seed " << seed << ", step " << step;
        }
    }
}

}  // namespace
}  // namespace embody::physics::stages
