// SPDX-License-Identifier: MIT
// Curvature of balls and planes; liquid that goes along with a thin obstacle.
#include "physics/fluid/pressure/surface_tension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/pressure/bound_liquid.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.01;

TEST(SurfaceTension, MattersOnCellsFinerThanTwiceTheCapillaryLength) {
    constexpr double sigma = 0.072, density = 998, g = 9.81;
    const double length = std::sqrt(sigma / (density * g));
    EXPECT_TRUE(is_tense({}, sigma, density, g, 1.99 * length));
    EXPECT_FALSE(is_tense({}, sigma, density, g, 2.01 * length));
    EXPECT_FALSE(is_tense({}, 0, density, g, 1e-6));
    EXPECT_TRUE(is_tense({}, sigma, density, 0, 1));  // nothing flattens it
}

TEST(SurfaceTension, TheShortestWavesBoundIt) {
    constexpr double density = 998, dt = 0.001;
    const double sigma = steady_tension(density, h, dt);
    EXPECT_NEAR(dt * dt, density * h * h * h / (4 * std::numbers::pi * sigma), 1e-12);
    EXPECT_NEAR(steady_tension(density, h, dt / 2), 4 * sigma, 1e-9);
    EXPECT_NEAR(steady_tension(density, 2 * h, dt), 8 * sigma, 1e-9);
}

TEST(SurfaceTension, APlaneHasNone) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {16, 8, 16}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    SurfacePressure surface;
    EXPECT_TRUE(surface.is_none());
    surface.measure(1, {}, block.grid, block.workers);
    EXPECT_FALSE(surface.is_none());
    const int liquid = block.index_at({0.085, 0.075, 0.085});
    EXPECT_NEAR(surface.at(liquid, liquid + block.grid.stride(1), 0.5), 0, 1e-2);
}

TEST(SurfaceTension, ABallHasTwiceItsTensionByItsRadius) {
    Random random(1);
    constexpr double radius = 6 * h, impulse = 0.5;
    const Vec3 center{0.08, 0.08, 0.08};
    std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {16, 16, 16});
    std::erase_if(particles, [&](const FluidParticle& p) {
        return length(Vec3{p.position[0], p.position[1], p.position[2]} - center) > radius;
    });
    LiquidBlock block(h, particles);
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    SurfacePressure surface;
    surface.measure(impulse, {}, block.grid, block.workers);
    double sum = 0;
    int count = 0;
    for (std::size_t row = 0; row < system.size(); ++row) {
        const auto cell = static_cast<int>(system.cell(row));
        for (int axis = 0; axis < 3; ++axis) {
            for (const int other : {cell - block.grid.stride(axis), cell + block.grid.stride(axis)}) {
                if (block.grid.row[other] >= 0) continue;
                const float fraction = system.gap_fraction(block.grid.surface[cell], block.grid.surface[other]);
                sum += surface.at(cell, other, fraction);
                ++count;
            }
        }
    }
    ASSERT_GT(count, 300);
    EXPECT_NEAR(sum / count, 2 * impulse / radius, 0.1 * 2 * impulse / radius);

    // What strays from it is drawn back, nothing else is.
    const float outside[3] = {static_cast<float>(center.x + radius + 1.2 * h), static_cast<float>(center.y),
                              static_cast<float>(center.z)};
    float shift[3] = {0, 0, 0};
    surface.draw_in(block.grid, outside, shift);
    EXPECT_LT(shift[0], 0);
    EXPECT_GT(shift[0], -0.3f * static_cast<float>(h));
    EXPECT_NEAR(shift[1], 0, 0.1 * h);
    const float inside[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
    float none[3] = {0, 0, 0};
    surface.draw_in(block.grid, inside, none);
    EXPECT_EQ(none[0], 0);
    surface.clear();
    EXPECT_EQ(surface.at(0, 1, 0.5), 0);
}

// Momentum of a body and of what it has bound is the same before and after; what it gives back is the difference.
TEST(BoundLiquid, SharesItsMomentumWithTheBody) {
    Random random(2);
    const auto shape = CollisionShape::create(BoxShape{{0.05, 0.005, 0.05}}).value();
    const Mat3 inertia{{2e-3, 1e-4, 0}, {1e-4, 3e-3, 2e-4}, {0, 2e-4, 2e-3}};
    constexpr double mass = 0.7, density = 1000;
    for (int trial = 0; trial < 20; ++trial) {
        LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}));
        PressureSystem system;
        system.build(block.grid, {}, block.workers);
        block.set_velocity([&](Vec3) {
            return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        });
        FluidObstacle plate{.shape = shape.get()};
        plate.inverse_mass = 1 / mass;
        plate.inverse_inertia = inverse_or_zero(inertia);
        MovingObstacle moving{.obstacle = &plate, .probe = ObstacleProbe(*shape, {{0.06, 0.06, 0.06}, {}}, {})};
        moving.center = {0.06, 0.06, 0.06};
        moving.linear_velocity = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        moving.angular_velocity = {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
        moving.is_in_reach = true;

        // None bound: an impulse does what it does to the body alone.
        bind_liquid(block.grid, density, {}, moving);
        const Vec3 alone = moving.response.linear_change({1, 2, 3}, {4, 5, 6});
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(alone[a], (a + 1) / mass, 1e-12);

        for (int i = 0; i < 30; ++i) {
            BoundFace face{.axis = i % 3, .fraction = static_cast<float>(random.between(0.1, 1))};
            const Vec3 place{random.between(0.03, 0.09), random.between(0.03, 0.09), random.between(0.03, 0.09)};
            face.cell = block.index_at(place);
            Vec3 n;
            n[face.axis] = 1;
            face.turn = cross(block.face_center(face.axis, block.cell_at(place)) - moving.center, n);
            moving.bound.push_back(face);
        }
        const Vec3 linear = moving.linear_velocity, angular = moving.angular_velocity;
        bind_liquid(block.grid, density, {}, moving);
        Vec3 momentum = mass * linear, spin = inertia * angular, after = mass * moving.linear_velocity,
             spin_after = inertia * moving.angular_velocity;
        for (const BoundFace& face : moving.bound) {
            EXPECT_GT(face.mass, 0);
            EXPECT_LE(face.mass, density * h * h * h * face.fraction * (1 + 1e-6));
            momentum[face.axis] += face.mass * face.speed;
            spin += face.turn * (face.mass * face.speed);
            const double speed = moving.linear_velocity[face.axis] + dot(face.turn, moving.angular_velocity);
            after[face.axis] += face.mass * speed;
            spin_after += face.turn * (face.mass * speed);
        }
        EXPECT_LT(length(after - momentum), 1e-9);
        EXPECT_LT(length(spin_after - spin), 1e-9);

        release_liquid(moving);
        EXPECT_LT(length(plate.impulse - mass * (moving.linear_velocity - linear)), 1e-9);
        EXPECT_LT(length(plate.angular_impulse - inertia * (moving.angular_velocity - angular)), 1e-9);
    }
}

TEST(BoundLiquid, AFixedBodyTakesItsMomentumAndStays) {
    const auto shape = CollisionShape::create(BoxShape{{0.05, 0.005, 0.05}}).value();
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    block.set_velocity([](Vec3) { return Vec3{0, -2, 0}; });
    FluidObstacle plate{.shape = shape.get()};
    MovingObstacle moving{.obstacle = &plate, .probe = ObstacleProbe(*shape, {{0.06, 0.06, 0.06}, {}}, {})};
    moving.is_in_reach = true;
    moving.bound.push_back({.axis = 1, .cell = block.index_at({0.065, 0.065, 0.065}), .fraction = 0.5f});
    bind_liquid(block.grid, 1000, {}, moving);
    EXPECT_EQ(moving.linear_velocity.y, 0);
    release_liquid(moving);
    EXPECT_NEAR(plate.impulse.y, -2 * 1000 * h * h * h * 0.5, 1e-9);
}

}  // namespace
}  // namespace embody::physics::fluid
