// SPDX-License-Identifier: MIT
// What begins as its own mirror image stays so: impacts of the same instant are one collision, whatever the order in
// which bodies were made.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double ball_radius = 0.0286, ball_mass = 0.17;  // of pool, m and kg (World Pool-Billiard Association)

struct Break {
    double speed = 1;        // of the cue ball, m/s
    double restitution = 1;  // between balls
    double mu = 0;           // between balls
    double gap = 0;          // between the balls of the rack, m
};

struct Rack {
    std::unique_ptr<World> world;
    std::vector<std::pair<BodyHandle, BodyHandle>> mirrored;  // each and its image in z; itself on the axis
};

// Fifteen balls in a triangle along X, made in any order, and a cue ball that rolls at the foremost one.
Rack rack_up(const Break& shot, Random& random) {
    Rack rack{make_world({}), {}};
    World& world = *rack.world;
    const Material cloth{.friction_static = 0.2,
                         .friction_dynamic = 0.2,
                         .restitution = 0.5,
                         .friction_combine = CombineRule::minimum,
                         .restitution_combine = CombineRule::minimum};
    const Material ivory{.friction_static = shot.mu,
                         .friction_dynamic = shot.mu,
                         .restitution = shot.restitution,
                         .friction_combine = CombineRule::minimum,
                         .restitution_combine = CombineRule::minimum};
    add_plane(world, cloth);
    const auto shape = world.create_shape(SphereShape{ball_radius}).value();
    const auto add_ball = [&](double x, double z, double speed) {
        return world
            .create_body({.shape = shape,
                          .position = {x, ball_radius, z},
                          .linear_velocity = {speed, 0, 0},
                          .angular_velocity = {0, 0, -speed / ball_radius},
                          .mass = {.mass = ball_mass},
                          .material = ivory,
                          .allow_sleep = false})
            .value();
    };
    struct Place {
        int row, number;
    };
    std::vector<Place> places;
    for (int row = 0; row < 5; ++row) {
        for (int number = 0; number <= row; ++number) places.push_back({row, number});
    }
    for (std::size_t i = places.size(); i > 1; --i) {
        std::swap(places[i - 1], places[random.below(static_cast<std::uint32_t>(i))]);
    }
    const double spacing = 2 * ball_radius + shot.gap;
    std::vector<BodyHandle> balls;
    for (const Place& place : places) {
        balls.push_back(
            add_ball(place.row * spacing * std::sqrt(3.0) / 2, (place.number - place.row / 2.0) * spacing, 0));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto is_image = [&](const Place& other) {
            return other.row == places[i].row && other.number == places[i].row - places[i].number;
        };
        const auto image = std::find_if(places.begin(), places.end(), is_image) - places.begin();
        rack.mirrored.emplace_back(balls[i], balls[static_cast<std::size_t>(image)]);
    }
    const BodyHandle cue = add_ball(-0.3, 0, shot.speed);
    rack.mirrored.emplace_back(cue, cue);
    return rack;
}

// The farthest that a ball is from where its image stands in the mirror, m.
double asymmetry(const Rack& rack) {
    double farthest = 0;
    for (const auto& [ball, image] : rack.mirrored) {
        const Vec3 there = rack.world->pose(image).position;
        farthest = std::max(farthest, length(rack.world->pose(ball).position - Vec3{there.x, there.y, -there.z}));
    }
    return farthest;
}

Break random_break(Random& random) {
    return {.speed = random.between(1, 10),
            .restitution = random.between(0.85, 1),
            .mu = random.below(3) == 0 ? 0 : random.between(0, 0.3)};
}

std::string words(const Break& shot) {
    return std::to_string(shot.speed) + " m/s, e " + std::to_string(shot.restitution) + ", mu " +
           std::to_string(shot.mu) + ", gap " + std::to_string(shot.gap);
}

// Numbers of contacts are floats, so that the order of two bodies changes their last digits; a loose rack passes on
// such a difference ten times as large with each row.
TEST(RandomBreaks, AreTheirOwnMirrorImages) {
    Random random(19);
    const int shots = wanted_cases("EMBODY_BREAKS", 60);
    for (int i = 0; i < shots; ++i) {
        Break shot = random_break(random);
        shot.gap = random.below(2) == 0 ? 0 : random.between(0, 1e-3);
        Rack rack = rack_up(shot, random);
        run(*rack.world, 0.3 / shot.speed + 0.1);
        EXPECT_LT(asymmetry(rack), 5e-3) << words(shot);
    }
}

}  // namespace
}  // namespace embody::physics
