// SPDX-License-Identifier: MIT
// Galilean invariance: only motion relative to one another counts. What flies or rides together behaves, and costs, as
// at rest; what meets at high speed does not pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/definitions/grain_material.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

Vec3 random_vector(Random& random, double most) {
    return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

BodyHandle add_body(World& world, const ShapeDefinition& shape, BodyDefinition body) {
    body.shape = world.create_shape(shape).value();
    return world.create_body(body).value();
}

/// A cloud of equal balls that drift slowly and meet, in a frame with a velocity, and what was counted in it.
struct Cloud {
    static constexpr int side = 8;
    static constexpr double diameter = 0.02;
    std::unique_ptr<World> world;
    std::vector<BodyHandle> balls;
    std::size_t pairs = 0, contacts = 0;
    std::uint32_t limits = 0;

    Cloud(std::uint64_t seed, Vec3 velocity, double drift) : world(make_world({.gravity = {}, .sleeping = false})) {
        Random random(seed);
        BodyDefinition ball{.shape = world->create_shape(SphereShape{diameter / 2}).value()};
        ball.material = grain_material(34, diameter);
        for (int i = 0; i < side * side * side; ++i) {
            const Vec3 place{static_cast<double>(i % side), static_cast<double>(i / side % side),
                             static_cast<double>(i / side / side)};
            ball.position = place * (1.1 * diameter);
            ball.linear_velocity = velocity + random_vector(random, drift);
            balls.push_back(world->create_body(ball).value());
        }
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            const StepReport& report = world->step();
            pairs += report.pairs;
            contacts += report.contacts;
            limits |= report.limits;
        }
    }
    [[nodiscard]] Vec3 place(std::size_t ball) const {
        return world->center_of_mass(balls[ball]) - world->center_of_mass(balls[0]);
    }
};

TEST(MovingFrames, WhatFliesTogetherTouchesAndCostsAsAtRest) {
    Random random(31);
    for (int family = 0; family < 6; ++family) {
        SCOPED_TRACE(family);
        const double drift = random.between(0.01, 0.1), speed = family < 3 ? random.between(0.1, 2) : 12;
        const auto seed = static_cast<std::uint64_t>(family);
        Cloud still(seed, {}, drift), flying(seed, random_vector(random, speed), drift);
        still.run(15);
        flying.run(15);
        EXPECT_GT(still.contacts, 100u);
        EXPECT_NEAR(static_cast<double>(flying.contacts) / static_cast<double>(still.contacts), 1, 0.03);
        // At rest some bounds stay behind their bodies, and with them some pairs.
        EXPECT_LT(flying.pairs, 1.02 * static_cast<double>(still.pairs));
        EXPECT_GT(flying.pairs, 0.8 * static_cast<double>(still.pairs));
        EXPECT_EQ(flying.limits, still.limits);
        // In the mean: what meets last magnifies each rounding, by up to a tenth of a diameter.
        double apart = 0;
        for (std::size_t i = 0; i < still.balls.size(); ++i)
            apart += distance(still.place(i), flying.place(i)) / static_cast<double>(still.balls.size());
        EXPECT_LT(apart, 0.01 * Cloud::diameter);
    }
}

/// An open box of 40 x 24 x 30 cm with walls of 2 cm, full of grains of 2 cm to a third.
struct Lorry {
    static constexpr double diameter = 0.02;
    static constexpr Vec3 half{0.2, 0.12, 0.15};
    std::unique_ptr<World> world;
    BodyHandle box;
    std::vector<BodyHandle> grains;

    explicit Lorry(Vec3 velocity, Vec3 spin = {}) {
        WorldSettings settings;
        settings.substeps = substeps_for_grains(diameter, settings);
        world = make_world(settings);
        constexpr double wall = 0.01;
        CompoundShape shape;
        const auto add_wall = [&](Vec3 half_extents, Vec3 place) {
            shape.children.push_back({.shape = BoxShape{half_extents}, .local = {place, {}}});
        };
        add_wall({half.x, wall, half.z}, {0, -wall, 0});
        for (const double side : {-1.0, 1.0}) {
            add_wall({wall, half.y, half.z}, {side * (half.x + wall), half.y - 2 * wall, 0});
            add_wall({half.x + 2 * wall, half.y, wall}, {0, half.y - 2 * wall, side * (half.z + wall)});
        }
        box = add_body(*world, shape,
                       {.kind = BodyKind::kinematic_body, .linear_velocity = velocity, .angular_velocity = spin});
        BodyDefinition grain{.shape = world->create_shape(SphereShape{diameter / 2}).value()};
        grain.material = grain_material(34, diameter);
        grain.mass.density = 2650;
        Random random(5);
        constexpr double a = 1.1 * diameter;
        for (double y = 0.6 * diameter; y < 0.08; y += a) {
            for (double x = -half.x + 0.6 * diameter; x < half.x - 0.6 * diameter; x += a) {
                for (double z = -half.z + 0.6 * diameter; z < half.z - 0.6 * diameter; z += a) {
                    grain.position = Vec3{x, y, z} + random_vector(random, 0.03 * diameter);
                    grain.linear_velocity = velocity + cross(spin, grain.position);
                    grains.push_back(world->create_body(grain).value());
                }
            }
        }
    }
    // Of its own frame.
    [[nodiscard]] bool holds_all() const {
        return std::all_of(grains.begin(), grains.end(), [&](BodyHandle grain) {
            const Vec3 p = inverse_transform_point(world->pose(box), world->center_of_mass(grain));
            return std::fabs(p.x) < half.x && std::fabs(p.z) < half.z && p.y > 0.4 * diameter && p.y < half.y;
        });
    }
};

// However fast it goes: the grains on it go as fast.
TEST(MovingFrames, ALorryKeepsItsSandAtAnySpeed) {
    Random random(32);
    for (int family = 0; family < 5; ++family) {
        const Vec3 velocity{random.between(-15, 15), 0, random.between(-15, 15)};
        SCOPED_TRACE(length(velocity));
        Lorry lorry(velocity);
        for (int step = 0; step < 60; ++step) lorry.world->step();
        EXPECT_TRUE(lorry.holds_all());
    }
}

// By 3 m/s² from rest on; and another one turns on the spot, its ends at 1 m/s.
TEST(MovingFrames, ALorryKeepsItsSandWhileItSpeedsUpAndTurns) {
    Lorry lorry({});
    for (int step = 0; step < 30; ++step) lorry.world->step();
    for (int step = 1; step <= 120; ++step) {
        ASSERT_TRUE(lorry.world->set_velocity(lorry.box, {3.0 * step / 60, 0, 0}, {}));
        lorry.world->step();
    }
    EXPECT_TRUE(lorry.holds_all());
    Lorry turning({}, {0, 4, 0});
    for (int step = 0; step < 60; ++step) turning.world->step();
    EXPECT_TRUE(turning.holds_all());
}

// A ball of 1 cm and a wall of 4 mm, both fast, either way.
TEST(MovingFrames, ABallDoesNotPassAWallThatMoves) {
    Random random(33);
    for (int i = 0; i < 60; ++i) {
        const double ball_speed = random.between(20, 300);
        const double wall_speed = i % 2 == 0 ? random.between(-30, 0) : random.between(0, 0.5 * ball_speed);
        SCOPED_TRACE(testing::Message() << "ball " << ball_speed << " m/s, wall " << wall_speed << " m/s");
        auto world = make_world({.gravity = {}});
        const auto wall = add_body(*world, BoxShape{{0.002, 0.5, 0.5}},
                                   {.kind = BodyKind::kinematic_body, .linear_velocity = {wall_speed, 0, 0}});
        const auto ball =
            add_body(*world, SphereShape{0.005},
                     {.position = {-random.between(0.5, 3), 0, 0}, .linear_velocity = {ball_speed, 0, 0}});
        for (int step = 0; step < 20; ++step) {
            world->step();
            ASSERT_LT(world->pose(ball).position.x, world->pose(wall).position.x) << "step " << step;
        }
    }
}

}  // namespace
}  // namespace embody::physics::stages
