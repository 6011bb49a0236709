// SPDX-License-Identifier: MIT
// The pressure's equation against its written-out matrix, and what its solution is for.
#include "physics/fluid/pressure/pressure_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/grid/faces.h"
#include "physics/fluid/liquid_block.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1;
constexpr int most = 400;

// (A x)_c = Σ w/θ (x_c − x_neighbour), from the grid alone.
std::vector<double> multiply(const FluidGrid& grid, const PressureSystem& system, const std::vector<double>& x) {
    std::vector<double> y(x.size(), 0);
    for (std::size_t row = 0; row < x.size(); ++row) {
        const auto cell = static_cast<int>(system.cell(row));
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                const int other = cell + side * grid.stride(axis);
                const double open = grid.open[axis][std::max(cell, other)];
                if (open <= 0) continue;
                if (grid.row[other] >= 0) {
                    y[row] += open * (x[row] - x[grid.row[other]]);
                } else {
                    y[row] += open / system.gap_fraction(grid.surface[cell], grid.surface[other]) * x[row];
                }
            }
        }
    }
    return y;
}

TEST(PressureSystem, GapIsTheFractionOfTheDistanceToTheSurface) {
    const PressureSystem system;
    EXPECT_FLOAT_EQ(system.gap_fraction(-0.25f, 0.75f), 0.25f);
    EXPECT_FLOAT_EQ(system.gap_fraction(-0.5f, 0.5f), 0.5f);
    EXPECT_FLOAT_EQ(system.gap_fraction(-0.5f, -0.5f), 1);  // no surface on the way
    EXPECT_GT(system.gap_fraction(-1e-9f, 1), 0);
    EXPECT_LT(system.gap_fraction(-1e-9f, 1), 0.01f);
}

TEST(PressureSystem, OfNoLiquidHasNoRows) {
    LiquidBlock block(h, {FluidParticle{.position = {0.5f, 0.5f, 0.5f}}});
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    EXPECT_EQ(system.size(), 0u);
    std::vector<double> x;
    EXPECT_LE(system.solve({}, x, 1e-6, most, block.workers), most);
}

TEST(PressureSystem, SolvesWhatTheMatrixSays) {
    Random random(1);
    for (const int workers : {1, 2}) {
        TaskPool pool(workers);
        for (int trial = 0; trial < 3; ++trial) {
            LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {14, 9, 11}));
            for (auto& open : block.grid.open) {
                for (float& fraction : open) fraction = random.unit() < 0.1 ? 0.0f : static_cast<float>(random.unit());
            }
            PressureSystem system;
            system.build(block.grid, {}, pool);
            ASSERT_GT(system.size(), 900u);
            std::vector<double> known(system.size());
            for (double& value : known) value = random.between(-1, 1);
            const auto b = multiply(block.grid, system, known);
            std::vector<double> x(system.size(), 0);
            constexpr double tolerance = 1e-9;
            EXPECT_LE(system.solve(b, x, tolerance, most, pool), most);
            const auto ax = multiply(block.grid, system, x);
            for (std::size_t row = 0; row < x.size(); ++row) EXPECT_NEAR(ax[row], b[row], 1e-6);
        }
    }
}

TEST(PressureSystem, SaysWhereTheIterationsDidNotSuffice) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {14, 9, 11}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    std::vector<double> b(system.size(), 1), x(system.size(), 0);
    EXPECT_EQ(system.solve(b, x, 1e-12, 2, block.workers), 3);
    // From the solution on there is nothing to do.
    x.assign(system.size(), 0);
    const int iterations = system.solve(b, x, 1e-9, most, block.workers);
    EXPECT_GT(iterations, 3);
    EXPECT_LE(system.solve(b, x, 1e-6, most, block.workers), 1);
}

TEST(PressureSystem, AnyVelocityBecomesFreeOfDivergence) {
    Random random(2);
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 8, 10}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    block.set_velocity([&](Vec3) { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; });
    std::vector<double> flow, x(system.size(), 0);
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    const double largest = *std::ranges::max_element(flow);
    for (double& value : flow) value *= -1 / (h * h);
    EXPECT_LE(system.solve(flow, x, 1e-8, most, block.workers), most);
    subtract_gradient(block.grid, {system, x, {}, 1}, block.grid.velocity, block.workers);
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    for (const double value : flow) EXPECT_NEAR(value, 0, 1e-5 * largest);
}

// A basin of walls two cells and more thick, whose inside is 8 × 8 cells.
struct Basin {
    Basin() {
        const auto add = [&](Vec3 half, Vec3 center) {
            shapes.push_back(CollisionShape::create(BoxShape{half}).value());
            walls.push_back({.body = static_cast<std::uint32_t>(walls.size()),
                             .shape = shapes.back().get(),
                             .is_static = true,
                             .pose = {center, {}}});
        };
        add({2, 0.4, 2}, {0.4, -0.4, 0.4});
        add({0.4, 2, 2}, {-0.4, 1, 0.4});
        add({0.4, 2, 2}, {1.2, 1, 0.4});
        add({2, 2, 0.4}, {0.4, 1, -0.4});
        add({2, 2, 0.4}, {0.4, 1, 1.2});
    }
    std::vector<std::unique_ptr<CollisionShape>> shapes;
    std::vector<FluidObstacle> walls;
};

TEST(PressureSystem, StandingWaterHasThePressureOfItsDepth) {
    Basin basin;
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 6, 8}), basin.walls);
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    EXPECT_GE(system.size(), 8u * 6 * 8);  // and what of the walls' cells has open faces
    // A step of gravity: u* = g dt at all faces.
    constexpr double g = -9.81, dt = 0.01;
    block.set_velocity([&](Vec3) { return Vec3{0, g * dt, 0}; });
    std::vector<double> flow, x(system.size(), 0);
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    for (double& value : flow) value *= -1 / h;
    EXPECT_LE(system.solve(flow, x, 1e-10, most, block.workers), most);
    for (std::size_t row = 0; row < x.size(); ++row) {
        const auto cell = static_cast<int>(system.cell(row));
        const int layer = block.grid.stride(2);
        const double y = (block.grid.lower()[1] + cell % layer / block.grid.stride(1) + 0.5) * h;
        EXPECT_NEAR(x[row], -g * dt * (0.6 - y), 1e-5);  // P/ρ
    }
    subtract_gradient(block.grid, {system, x, {}, 1 / h}, block.grid.velocity, block.workers);
    for (const std::uint32_t cell : {system.cell(0), system.cell(system.size() / 2), system.cell(system.size() - 1)}) {
        for (int axis = 0; axis < 3; ++axis) {
            const bool is_open = block.grid.open[axis][cell] > 0;
            EXPECT_NEAR(is_open ? block.grid.velocity[axis][cell] : 0.0f, 0, 1e-5);
        }
    }
}

TEST(PressureSystem, AFloatingBodyAndTheLiquidKeepTheirMomentum) {
    // A floating box wholly inside of the liquid: momentum goes from one to the other, and none comes to be.
    const auto shape = CollisionShape::create(BoxShape{{0.2, 0.2, 0.2}}).value();
    constexpr double density = 1000, body_mass = 40;
    FluidObstacle box{.shape = shape.get(), .pose = {{0.8, 0.8, 0.8}, {}}, .center = {0.8, 0.8, 0.8}};
    box.inverse_mass = 1 / body_mass;
    box.inverse_inertia = Mat3::identity() * (1 / (body_mass * 0.16 / 6));
    box.linear_velocity = {0, -1, 0};
    auto particles = fill_cells(h, {0, 0, 0}, {16, 16, 16});
    std::erase_if(particles, [](const FluidParticle& p) {
        return std::ranges::all_of(p.position, [](float x) { return x > 0.6f && x < 1.0f; });
    });
    LiquidBlock block(h, particles, std::span(&box, 1));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    block.obstacles.list_areas(block.grid, {});
    MovingObstacle& moving = block.obstacles.moving().front();
    ASSERT_TRUE(moving.is_in_reach);

    // The surface of what is wholly under water is closed, and a pressure that rises with the depth lifts its volume.
    Vec3 area, lift;
    for (const ObstacleArea& part : moving.areas) {
        area += part.area;
        const auto cell = static_cast<int>(system.cell(static_cast<std::size_t>(part.row)));
        const double y = block.grid.lower()[1] + cell % block.grid.stride(2) / block.grid.stride(1) + 0.5;
        lift -= part.area * (y * h);
    }
    EXPECT_LT(length(area), 1e-6);
    EXPECT_NEAR(lift.y, 0.4 * 0.4 * 0.4, 1e-4);
    EXPECT_NEAR(lift.x, 0, 1e-6);

    bind_liquid(block.grid, density, {}, moving);
    std::vector<double> flow, x(system.size(), 0);
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    for (double& value : flow) value *= -density / h;
    system.set_bodies(block.obstacles.moving(), density / h);
    EXPECT_LE(system.solve(flow, x, 1e-7, most, block.workers), most);
    subtract_gradient(block.grid, {system, x, {}, 1 / (density * h)}, block.grid.velocity, block.workers);
    Vec3 impulse, moment;
    for (const ObstacleArea& part : moving.areas) {
        impulse += part.area * x[static_cast<std::size_t>(part.row)];
        moment += part.moment * x[static_cast<std::size_t>(part.row)];
    }
    moving.linear_velocity += moving.response.linear_change(impulse, moment);
    moving.angular_velocity += moving.response.angular_change(impulse, moment);
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    for (const double value : flow) EXPECT_NEAR(value, 0, 1e-8);
    // It is slowed by the added mass of the liquid, whose momentum is what it lost (faces at the surface carry less).
    EXPECT_GT(impulse.y, 0);
    EXPECT_LT(moving.linear_velocity.y, 0);
    EXPECT_GT(moving.linear_velocity.y, -0.9);
    EXPECT_NEAR(impulse.x, 0, 1e-3 * impulse.y);
    EXPECT_LT(length(moving.angular_velocity), 1e-3);
    // A flow without divergence carries no momentum but that of the surface's pressure: the body's is all that the
    // faces have, with the liquid displaced counted as moving with it.
    EXPECT_NEAR(body_mass * (moving.linear_velocity.y + 1), impulse.y, 1e-6 * impulse.y);
}

}  // namespace
}  // namespace embody::physics::fluid
