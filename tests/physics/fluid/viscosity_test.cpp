// SPDX-License-Identifier: MIT
// Viscosity of shear flows with known solutions; what moves rigidly feels nothing.
#include "physics/fluid/pressure/viscosity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1;
constexpr int most = 600;
constexpr FluidViscositySettings settings{.max_iterations = most};

TEST(Viscosity, IsLeftOutWhereItIsRoundingOnly) {
    EXPECT_FALSE(is_viscous({1000, 0, 0}, {}, h, 0.01));
    EXPECT_FALSE(is_viscous({1000, 0.001, 0}, {}, h, 0.01));  // water: ν dt/h² = 1e-6
    EXPECT_TRUE(is_viscous({1000, 10, 0}, {}, h, 0.01));
    EXPECT_TRUE(is_viscous({1000, 0, 5}, {}, h, 0.01));
}

TEST(Viscosity, ThickLayersStickAndThinOnesSlide) {
    EXPECT_LT(sticking_of({1000, 0.001, 0}, {}, h, 1), 1e-6);
    EXPECT_GT(sticking_of({1000, 1e4, 0}, {}, h, 1), 0.999);
    EXPECT_NEAR(sticking_of({1000, 25, 0}, {}, h, 1), 0.5, 1e-9);  // a cell's Reynolds number of 4
    EXPECT_GT(sticking_of({1000, 0.001, 1e5}, {}, h, 1), 0.99);    // what yields that late
    double last = 1;
    for (const double speed : {0.01, 0.1, 1.0, 10.0}) {
        const double now = sticking_of({1000, 25, 0}, {}, h, speed);
        EXPECT_LT(now, last);
        last = now;
    }
}

// A free block whose faces are known, as liquid cells are.
struct FreeBlock : LiquidBlock {
    explicit FreeBlock(Cell size) : LiquidBlock(h, fill_cells(h, {0, 0, 0}, size)) { system.build(grid, {}, workers); }
    PressureSystem system;
};

// Iterations of a viscous step.
int solve(const FluidProperties& liquid, double dt, LiquidBlock& block) {
    ViscositySystem system;
    system.begin(liquid, dt, settings, block.grid, block.obstacles);
    return system.solve(liquid, dt, block.grid, block.obstacles);
}

TEST(Viscosity, RigidMotionsStayAsTheyAre) {
    FreeBlock block({10, 9, 8});
    const auto motion = [](Vec3 p) { return Vec3{1, -2, 3} + cross(Vec3{2, 1, -1}, p); };
    block.set_velocity(motion);
    EXPECT_LE(solve({1000, 500, 0}, 0.01, block), most);
    for (const Cell& corner : block.grid.tiles()) {
        block.grid.for_cells(corner, [&](int cell, const Cell& c) {
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(block.grid.velocity[axis][cell], motion(block.face_center(axis, c))[axis], 1e-4);
            }
        });
    }
}

TEST(Viscosity, TakesEnergyButNoMomentum) {
    Random random(1);
    for (const double yield_stress : {0.0, 50.0}) {
        FreeBlock block({10, 9, 8});
        block.set_velocity([&](Vec3) {
            return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        });
        // By the inertia that the equation gives faces: the liquid of their control volumes.
        const auto sums = [&] {
            const FluidGrid& grid = block.grid;
            Vec3 momentum;
            double energy = 0;
            for (const Cell& corner : grid.tiles()) {
                grid.for_cells(corner, [&](int cell, const Cell&) {
                    for (int axis = 0; axis < 3; ++axis) {
                        const int below = cell - grid.stride(axis);
                        if (!grid.known[axis][cell] || (grid.row[cell] < 0 && grid.row[below] < 0)) continue;
                        const auto filled = [&](int at) { return std::clamp(0.5f - grid.surface[at], 0.0f, 1.0f); };
                        const double mass = std::max(0.05f, (filled(cell) + filled(below)) / 2);
                        const double u = grid.velocity[axis][cell];
                        momentum[axis] += mass * u;
                        energy += mass * u * u / 2;
                    }
                });
            }
            return std::pair(momentum, energy);
        };
        const auto before = sums();
        EXPECT_LE(solve({1000, 100, yield_stress}, 0.01, block), most);
        const auto after = sums();
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(after.first[a], before.first[a], 0.02);
        EXPECT_LT(after.second, 0.8 * before.second);
        EXPECT_GT(after.second, 0);
    }
}

// Between two plates u = sin(π y/H) is damped by 1/(1 + ν dt λ), λ = 2 (1 − cos(π/N))/h² on N cells.
TEST(Viscosity, ShearBetweenPlatesIsDampedAsTheEquationSays) {
    constexpr int cells = 8;
    const auto plate = CollisionShape::create(BoxShape{{4, 0.3, 4}}).value();
    std::vector<FluidObstacle> plates;
    for (const double y : {-0.3, cells * h + 0.3}) {
        plates.push_back({.body = static_cast<std::uint32_t>(plates.size()),
                          .shape = plate.get(),
                          .is_static = true,
                          .pose = {{1, y, 1}, {}}});
    }
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {24, cells, 24}), plates);
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    ASSERT_GE(system.size(), 24u * cells * 24);
    constexpr double pi = std::numbers::pi, density = 1000, viscosity = 200, dt = 0.02;
    const auto profile = [](double y) { return std::sin(pi * y / (cells * h)); };
    block.set_velocity([&](Vec3 p) { return Vec3{profile(p.y), 0, 0}; });
    EXPECT_LE(solve({density, viscosity, 0}, dt, block), most);
    const double damped = 1 / (1 + viscosity / density * dt * 2 * (1 - std::cos(pi / cells)) / (h * h));
    EXPECT_LT(damped, 0.95);
    for (int i = 0; i < cells; ++i) {
        const double y = (i + 0.5) * h;
        EXPECT_NEAR(block.grid.velocity[0][block.index_at({1.25, y, 1.25})], damped * profile(y), 2e-3);
    }
}

TEST(Viscosity, AMovingPlateDragsAndIsDraggedBackAlike) {
    const auto shape = CollisionShape::create(BoxShape{{0.4, 0.2, 0.4}}).value();
    constexpr double mass = 200, density = 1000;
    FluidObstacle box{.shape = shape.get(), .pose = {{0.8, -0.2, 0.8}, {}}, .center = {0.8, -0.2, 0.8}};
    box.inverse_mass = 1 / mass;
    box.inverse_inertia = Mat3::identity() * (1 / (mass * 0.05));
    box.linear_velocity = {1, 0, 0};
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {16, 8, 16}), std::span(&box, 1));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    block.set_velocity([](Vec3) { return Vec3{}; });
    EXPECT_LE(solve({density, 200, 0}, 0.01, block), most);
    const MovingObstacle& moving = block.obstacles.moving().front();
    EXPECT_LT(moving.linear_velocity.x, 1);
    EXPECT_GT(moving.linear_velocity.x, 0);
    // The impulse is what its velocity changed by.
    EXPECT_NEAR(box.impulse.x, mass * (moving.linear_velocity.x - 1), 1e-6 * mass);
    // The liquid at it goes along.
    EXPECT_GT(block.grid.velocity[0][block.index_at({0.8, 0.05, 0.8})], 0.02);
    double momentum = 0;
    for (const Cell& corner : block.grid.tiles()) {
        block.grid.for_cells(corner, [&](int cell, const Cell&) {
            const int below = cell - 1;
            if (block.grid.row[cell] < 0 && block.grid.row[below] < 0) return;
            if (!(block.grid.open[0][cell] > 0)) return;
            const auto filled = [&](int at) { return std::clamp(0.5f - block.grid.surface[at], 0.0f, 1.0f); };
            momentum += density * h * h * h * block.grid.open[0][cell] * (filled(cell) + filled(below)) / 2 *
                        block.grid.velocity[0][cell];
        });
    }
    EXPECT_NEAR(momentum, -box.impulse.x, 0.02 * momentum);
}

}  // namespace
}  // namespace embody::physics::fluid
