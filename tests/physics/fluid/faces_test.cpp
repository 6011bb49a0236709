// SPDX-License-Identifier: MIT
// Face velocities: continued beyond the liquid, summed to flows, changed by gradients.
#include "physics/fluid/grid/faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1;

Vec3 any_velocity(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

TEST(FluidFaces, VelocityAroundAFaceIsExactForLinearFields) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    const auto field = [](Vec3 p) {
        return Vec3{1 + p.x - 2 * p.y + 3 * p.z, -2 + 2 * p.x + p.y - p.z, 3 - p.x + p.y + 2 * p.z};
    };
    block.set_velocity(field);
    const Cell c = block.cell_at({0.45, 0.45, 0.45});
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 found = velocity_around(block.grid, axis, block.grid.index(c));
        const Vec3 wanted = field(block.face_center(axis, c));
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(found[a], wanted[a], 2e-6);
    }
}

TEST(FluidFaces, UnknownVelocitiesWithoutKnownOnesStayUnknown) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    for (auto& known : block.grid.known) std::ranges::fill(known, 0);
    extrapolate(block.grid, block.grid.velocity, 3, block.workers);
    for (const auto& known : block.grid.known) EXPECT_EQ(std::count(known.begin(), known.end(), 1), 0);
}

TEST(FluidFaces, ALayerIsTheMeanOfTheKnownNeighbours) {
    Random random(1);
    for (int trial = 0; trial < 4; ++trial) {
        LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
        FluidGrid& grid = block.grid;
        block.set_velocity([&](Vec3) { return any_velocity(random); });
        for (const Cell& corner : grid.tiles()) {
            grid.for_cells(corner, [&](int cell, const Cell&) {
                for (auto& known : grid.known) known[cell] = random.unit() < 0.1;
            });
        }
        const auto velocity = grid.velocity;
        const auto known = grid.known;
        extrapolate(grid, grid.velocity, 1, block.workers);
        std::size_t added = 0;
        for (const Cell& corner : grid.tiles()) {
            grid.for_cells(corner, [&](int cell, const Cell&) {
                for (int axis = 0; axis < 3; ++axis) {
                    double sum = 0;
                    int count = 0;
                    for (int other = 0; other < 3; ++other) {
                        for (const int beside : {cell - grid.stride(other), cell + grid.stride(other)}) {
                            if (!known[axis][beside]) continue;
                            sum += velocity[axis][beside];
                            ++count;
                        }
                    }
                    const bool is_new = !known[axis][cell] && count > 0;
                    EXPECT_EQ(grid.known[axis][cell] != 0, known[axis][cell] || is_new);
                    EXPECT_NEAR(grid.velocity[axis][cell], is_new ? sum / count : velocity[axis][cell], 1e-6);
                    added += is_new;
                }
            });
        }
        EXPECT_GT(added, 1000u);
    }
}

TEST(FluidFaces, AConstantFieldIsContinuedAsItIs) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {4, 4, 4}));
    FluidGrid& grid = block.grid;
    const Vec3 velocity{1, -2, 0.5};
    std::array<std::vector<std::uint8_t>, 3> before = grid.known;
    block.set_velocity([&](Vec3) { return velocity; });
    extrapolate(grid, grid.velocity, 3, block.workers);
    // By so many layers in the direction of an axis, and no farther.
    const Cell c = block.cell_at({0.25, 0.25, 0.25});
    for (int axis = 0; axis < 3; ++axis) {
        int last_before = 0, last = 0;
        for (int i = 0; i < 9; ++i) {
            Cell beside = c;
            beside[(axis + 1) % 3] += i;
            const int cell = grid.index(beside);
            if (before[axis][cell]) last_before = i;
            if (!grid.known[axis][cell]) continue;
            last = i;
            EXPECT_FLOAT_EQ(grid.velocity[axis][cell], static_cast<float>(velocity[axis]));
        }
        EXPECT_EQ(last, last_before + 3);
    }
}

TEST(FluidFaces, DropsTellFacesThatTheyReach) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {4, 4, 4}));
    FluidGrid& grid = block.grid;
    for (auto& known : grid.known) std::ranges::fill(known, 0);
    const int cell = block.index_at({0.25, 0.25, 0.25});
    grid.open[1][cell] = 0;
    admit_drops(grid, block.workers);
    EXPECT_TRUE(grid.known[0][cell]);
    EXPECT_FALSE(grid.known[1][cell]);  // it is shut
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner,
                       [&](int at, const Cell&) { EXPECT_EQ(grid.known[2][at] != 0, grid.mass[2][at] > 1e-6f); });
    }
}

TEST(FluidFaces, OutflowOfALinearFieldIsItsDivergence) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    ASSERT_GT(system.size(), 400u);
    block.set_velocity([](Vec3 p) { return Vec3{1 + 2 * p.x + p.y, 3 * p.y - p.z, 4 * p.x - 1.5 * p.z}; });
    std::vector<double> flow;
    outflow(block.grid, block.obstacles, system, flow, block.workers);
    ASSERT_EQ(flow.size(), system.size());
    for (const double out : flow) EXPECT_NEAR(out, (2 + 3 - 1.5) * h * h * h, 1e-7);
}

TEST(FluidFaces, GradientsOfALinearPressureAreExact) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    FluidGrid& grid = block.grid;
    PressureSystem system;
    system.build(grid, {}, block.workers);
    const Vec3 slope{3, -2, 5};
    std::vector<double> x(system.size());
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell& c) {
            if (grid.row[cell] >= 0) x[grid.row[cell]] = dot(slope, grid.center(c));
        });
    }
    block.set_velocity([](Vec3) { return Vec3{1, 1, 1}; });
    constexpr double scale = 0.7;
    subtract_gradient(grid, {system, x, {}, scale}, grid.velocity, block.workers);
    std::size_t inner = 0, outer = 0;
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            for (int axis = 0; axis < 3; ++axis) {
                const int below = cell - grid.stride(axis);
                const int upper = grid.row[cell], lower = grid.row[below];
                EXPECT_EQ(grid.known[axis][cell] != 0, upper >= 0 || lower >= 0);
                if (upper >= 0 && lower >= 0) {
                    EXPECT_NEAR(grid.velocity[axis][cell], 1 - scale * slope[axis] * h, 1e-6);
                    ++inner;
                } else if (upper >= 0 || lower >= 0) {
                    // Nothing at the surface, so far away.
                    const int liquid = upper >= 0 ? cell : below, air = upper >= 0 ? below : cell;
                    const double travel = system.gap_fraction(grid.surface[liquid], grid.surface[air]);
                    const double rise = x[grid.row[liquid]] / travel * (upper >= 0 ? 1 : -1);
                    EXPECT_NEAR(grid.velocity[axis][cell], 1 - scale * rise, 1e-4 * (1 + std::fabs(rise)));
                    ++outer;
                }
            }
        });
    }
    EXPECT_GT(inner, 1000u);
    EXPECT_GT(outer, 300u);
}

TEST(FluidFaces, ShutFacesMoveWithTheirObstacle) {
    const auto shape = CollisionShape::create(BoxShape{{0.5, 0.25, 0.5}}).value();
    for (const double sticking : {0.0, 1.0}) {
        // Its upper side lies at y = 0, between two layers of cells.
        FluidObstacle box{.shape = shape.get(), .pose = {{0.4, -0.25, 0.4}, {}}, .center = {0.4, -0.25, 0.4}};
        box.linear_velocity = {0.3, 0.7, -0.2};
        LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}), std::span(&box, 1));
        FluidGrid& grid = block.grid;
        block.set_velocity([](Vec3) { return Vec3{5, 5, 5}; });
        for (auto& known : grid.known) std::ranges::fill(known, 1);
        follow_obstacles(
            grid, block.obstacles, [sticking](int, int) { return sticking; }, block.workers);
        // Along the normal as fast as the obstacle, along it as the liquid where it slides; mirrored where it sticks.
        const int inside = block.index_at({0.45, -0.05, 0.45});
        EXPECT_NEAR(grid.velocity[1][inside], sticking == 0 ? 0.7 : 2 * 0.7 - 5, 1e-4);
        EXPECT_NEAR(grid.velocity[0][inside], sticking == 0 ? 5 : 2 * 0.3 - 5, 1e-4);
        EXPECT_EQ(grid.velocity[0][block.index_at({0.45, 0.05, 0.45})], 5);
    }
}

TEST(FluidFaces, WithoutTensionTheSurfaceAddsNoPressure) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    SurfacePressure surface;
    surface.measure(2, {}, block.grid, block.workers);
    std::vector<double> b(system.size(), 1);
    add_surface_pressure(block.grid, system, surface, b, block.workers);
    EXPECT_TRUE(std::ranges::any_of(b, [](double value) { return value != 1; }));
    surface.clear();
    EXPECT_TRUE(surface.is_none());
    b.assign(system.size(), 1);
    surface.measure(0, {}, block.grid, block.workers);
    add_surface_pressure(block.grid, system, surface, b, block.workers);
    for (const double value : b) EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace embody::physics::fluid
