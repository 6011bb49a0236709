// SPDX-License-Identifier: MIT
// Soft solids in time: what the length of a substep makes of a swing and of a bounce.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

double whole_energy(const World& world) {
    const Conserved sum = world.conserved();
    return sum.kinetic_energy + sum.potential_energy;
}

// Of a beam of 1 × 0.1 × 0.1 m that is let go straight, Hz; and by how much its swing changes in a period.
struct Swing {
    double frequency = 0, kept = 0;
};
Swing swing_of_beam(double rate, int cells) {
    DeformableDefinition beam =
        tetrahedral_brick({1, 0.1, 0.1}, {10 * cells, cells, cells},
                          {.density = 1200, .youngs_modulus = 5e7, .poisson_ratio = 0.3, .rayleigh_damping = 0});
    std::vector<std::size_t> end;
    for (std::uint32_t i = 0; i < beam.nodes.size(); ++i) {
        if (beam.nodes[i].x == 0) beam.pinned.push_back(i);
        if (beam.nodes[i].x == 1) end.push_back(i);
    }
    const auto world = make_world({.time_step = 1 / rate, .sleeping = false});
    const DeformableHandle handle = world->create_deformable(beam).value();
    std::vector<double> height;
    for (int k = 0; k < static_cast<int>(3 * rate); ++k) {
        world->step();
        double sum = 0;
        for (const std::size_t i : end) sum += world->node_positions(handle)[i].y - beam.nodes[i].y;
        height.push_back(sum / static_cast<double>(end.size()));
    }
    const auto period = static_cast<std::ptrdiff_t>(0.35 * rate);
    const auto [low, high] = std::minmax_element(height.begin(), height.begin() + period);
    const double middle = (*low + *high) / 2, first_swing = *high - middle;
    std::vector<double> crossings;
    for (std::size_t k = 1; k < height.size(); ++k) {
        if (height[k - 1] < middle && height[k] >= middle)
            crossings.push_back(static_cast<double>(k) + (middle - height[k - 1]) / (height[k] - height[k - 1]));
    }
    if (crossings.size() < 3) return {};
    const double periods = static_cast<double>(crossings.size() - 1);
    const double last_swing = *std::max_element(height.end() - period, height.end()) - middle;
    return {periods * rate / (crossings.back() - crossings.front()),
            std::pow(std::max(0.0, last_swing / first_swing), 1 / periods)};
}

// Beside short steps of the same mesh, so that its own error does not count.
TEST(SoftTime, AnUndampedBeamSwingsAsWithShortSteps) {
    const Swing right = swing_of_beam(480, 2), usual = swing_of_beam(60, 2);
    ASSERT_GT(right.frequency, 0);
    EXPECT_NEAR(usual.frequency / right.frequency, 1, 0.01);
    EXPECT_NEAR(usual.kept, 1, 0.005);
}

DeformableDefinition soft_ball(double radius, int cells, double density, double stiffness, double damping) {
    DeformableDefinition ball = tetrahedral_brick(
        {2, 2, 2}, {cells, cells, cells},
        {.density = density, .youngs_modulus = stiffness, .poisson_ratio = 0.45, .rayleigh_damping = damping});
    // P. Nowell, "Mapping a cube to a sphere", 2005.
    for (Vec3& p : ball.nodes) {
        const Vec3 q = p - Vec3{1, 1, 1}, s{q.x * q.x, q.y * q.y, q.z * q.z};
        const auto along = [](double x, double a, double b) {
            return x * std::sqrt(std::max(0.0, 1 - a / 2 - b / 2 + a * b / 3));
        };
        p = radius * Vec3{along(q.x, s.y, s.z), along(q.y, s.z, s.x), along(q.z, s.x, s.y)};
    }
    return ball;
}

// A ball or a cube whose faces are level that falls on the floor: how much of its speed it comes back with.
struct Bounce {
    double restitution = 0, energy = 0;  // the latter: the maximum over the first one
};
Bounce bounce_of(DeformableDefinition thing, double half_height, double fall) {
    const auto world = make_world({});
    add_plane(*world, {});
    thing.pose.position.y += fall + half_height;
    const DeformableHandle handle = world->create_deformable(thing).value();
    const double energy = whole_energy(*world);
    Bounce bounce;
    double last = world->center_of_mass(handle).y, top = 0;
    bool has_hit = false;
    for (int k = 0; k < 240; ++k) {
        world->step();
        const double height = world->center_of_mass(handle).y;
        bounce.energy = std::max(bounce.energy, whole_energy(*world) / energy);
        has_hit = has_hit || height > last;
        if (has_hit && height < last && last - half_height > 1e-3 * fall) break;
        if (has_hit) top = std::max(top, height);
        last = height;
    }
    bounce.restitution = std::sqrt(std::max(0.0, top - half_height) / fall);
    return bounce;
}

// Of any size, stiffness, damping and height of fall, on steps that are longer than most of the impacts.
TEST(SoftTime, BallsAndCubesComeBackAsTheirRestitutionSays) {
    Random random(22);
    for (int k = 0; k < 24; ++k) {
        const double half = random.between(0.05, 0.15), stiffness = std::pow(10, random.between(4.7, 6.7));
        const double fall = random.between(0.5, 2), asked = random.between(0.1, 0.8);
        const double damping = k % 3 == 0 ? 0 : std::pow(10, random.between(-3, -1.5));
        DeformableDefinition thing = soft_ball(half, 4, 1000, stiffness, damping);
        if (k % 2 == 0) {
            thing = tetrahedral_brick(
                {2 * half, 2 * half, 2 * half}, {3, 3, 3},
                {.density = 1000, .youngs_modulus = stiffness, .poisson_ratio = 0.45, .rayleigh_damping = damping});
            thing.pose.position = {-half, -half, -half};
        }
        thing.material.restitution = asked;
        const Bounce bounce = bounce_of(thing, half, fall);
        EXPECT_NEAR(bounce.restitution, asked, 0.12)
            << k << ": " << stiffness << " Pa, " << damping << " s, " << half << " m, falls " << fall << " m";
        EXPECT_LT(bounce.energy, 1.001) << k;
    }
}

// Of a ball whose floor is taken away when it is pressed in; kg m/s, ten steps later.
double momentum_without_floor(double restitution) {
    const auto world = make_world({});
    const ShapeHandle shape = world->create_shape(BoxShape{{2, 0.5, 2}}).value();
    const BodyHandle floor =
        world->create_body({.kind = BodyKind::static_body, .shape = shape, .position = {0, -0.5, 0}}).value();
    DeformableDefinition ball = soft_ball(0.1, 4, 1000, 5e4, 0);
    ball.material.restitution = restitution;
    ball.pose.position = {0, 0.5, 0};
    const DeformableHandle handle = world->create_deformable(ball).value();
    for (int i = 0; i < 60 && world->center_of_mass(handle).y > 0.098; ++i) world->step();
    EXPECT_LT(world->center_of_mass(handle).y, 0.098);
    EXPECT_TRUE(world->destroy_body(floor).ok());
    run(*world, 1.0 / 6);
    return world->conserved().linear_momentum.y;
}

TEST(SoftTime, AFloorThatIsTakenAwayThrowsNothingBack) {
    const double alone = momentum_without_floor(0);
    EXPECT_LT(alone, 0);
    EXPECT_NEAR(momentum_without_floor(0.8), alone, 1e-6 * std::fabs(alone));
}

TEST(SoftTime, WhatBouncesComesToRest) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    DeformableDefinition ball = soft_ball(0.1, 4, 1000, 3e5, 0.01);
    ball.material.restitution = 0.7;
    ball.pose.position = {0, 1, 0};
    const DeformableHandle handle = world->create_deformable(ball).value();
    run(*world, 12);
    EXPECT_TRUE(world->is_asleep(handle));
}

// In free space; two solids with their momentum, of which a solid and a body lose up to a tenth.
TEST(SoftTime, TwoThatMeetPartAsTheirRestitutionSays) {
    Random random(23);
    for (int k = 0; k < 12; ++k) {
        const auto world = make_world({.gravity = {}});
        const double asked = random.between(0.2, 0.8), speed = random.between(1, 5);
        DeformableDefinition ball = soft_ball(0.1, 3, 1000, std::pow(10, random.between(4.7, 6.5)), 0.004);
        ball.material.restitution = asked;
        ball.pose.position = {0, 0.15, 0};
        ball.linear_velocity = {0, -speed, 0};
        const DeformableHandle first = world->create_deformable(ball).value();
        const Vec3 first_momentum = world->conserved().linear_momentum;
        Vec3 other_velocity;
        if (k % 2 == 0) {
            BodyDefinition body;
            body.shape = world->create_shape(SphereShape{0.1}).value();
            body.position = {0, -0.15, 0};
            body.mass.mass = random.between(1, 20);
            const BodyHandle handle = world->create_body(body).value();
            run(*world, 0.5);
            other_velocity = world->linear_velocity(handle);
        } else {
            ball.pose.position = {0, -0.15, 0};
            ball.linear_velocity = {};
            const DeformableHandle handle = world->create_deformable(ball).value();
            const Vec3 from = (run(*world, 0.5), world->center_of_mass(handle));
            run(*world, 0.1);
            other_velocity = (world->center_of_mass(handle) - from) / 0.1;
        }
        const Vec3 momentum = world->conserved().linear_momentum;
        if (k % 2 != 0) EXPECT_LT(length(momentum - first_momentum), 0.01 * length(first_momentum)) << k;
        const Vec3 from = world->center_of_mass(first);
        run(*world, 0.1);
        const double parted = (world->center_of_mass(first) - from).y / 0.1 - other_velocity.y;
        EXPECT_NEAR(parted / speed, asked, 0.12) << k;
    }
}

}  // namespace
}  // namespace embody::physics
