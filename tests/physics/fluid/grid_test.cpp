// SPDX-License-Identifier: MIT
// The grid of a fluid: what it covers, how it sorts, which cells are liquid.
#include "physics/fluid/grid/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "physics/fluid/grid/four.h"
#include "physics/fluid/grid/liquid_cells.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/particles/particle.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1;
constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

FluidParticle at(float x, float y, float z) { return {.position = {x, y, z}}; }

Cell cell_of(const FluidGrid& grid, const FluidParticle& particle) {
    Cell c{};
    for (int a = 0; a < 3; ++a) c[a] = static_cast<int>(grid.in_cells(particle.position[a], a));
    return c;
}

TEST(FluidGrid, CoversNothingWhereThereAreNoParticles) {
    TaskPool workers(1);
    FluidGrid grid(h);
    std::vector<FluidParticle> none;
    EXPECT_EQ(grid.cover(none, {}, workers), 0u);
    EXPECT_TRUE(grid.tiles().empty());
}

TEST(FluidGrid, RemovesParticlesAtNonFiniteOrHugePositions) {
    TaskPool workers(1);
    FluidGrid grid(h);
    std::vector<FluidParticle> particles{at(0, nan, 0), at(0.5f, 0.5f, 0.5f), at(infinite, 0, 0), at(0, 0, -3e30f)};
    particles[1].id = 7;
    EXPECT_EQ(grid.cover(particles, {}, workers), 3u);
    ASSERT_EQ(particles.size(), 1u);
    EXPECT_EQ(particles[0].id, 7u);
    std::vector<FluidParticle> lost{at(nan, nan, nan)};
    EXPECT_EQ(grid.cover(lost, {}, workers), 1u);
    EXPECT_TRUE(lost.empty());
}

TEST(FluidGrid, RemovesStrayParticlesThatWouldNeedTooLargeABox) {
    TaskPool workers(1);
    FluidGrid grid(h);
    std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {6, 6, 6});
    const std::size_t count = particles.size();
    particles.push_back(at(1e5f, 1e5f, 1e5f));
    EXPECT_EQ(grid.cover(particles, {}, workers), 1u);
    EXPECT_EQ(particles.size(), count);
    double cells = 1;
    for (const int size : grid.size()) cells *= size;
    EXPECT_LE(cells, static_cast<double>(FluidCellSettings{}.min_box_cells));
}

TEST(FluidGrid, KeepsStraysAsLongAsItsBoxHasCellsForThemAll) {
    TaskPool workers(1);
    FluidCellSettings settings;
    settings.min_box_cells = 100'000;
    for (const auto& [per_particle, wanted] : {std::pair{16u, 0u}, {14u, 1u}}) {
        settings.box_cells_per_particle = per_particle;
        FluidGrid grid(h);
        std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {10, 10, 10});
        ASSERT_EQ(particles.size(), 8000u);
        particles.push_back(at(10.05f, 0.05f, 0.05f));  // with the tiles around, 15 cells for each
        EXPECT_EQ(grid.cover(particles, settings, workers), wanted) << per_particle;
    }
}

TEST(FluidGrid, BoxHoldsOneParticleWithTilesAround) {
    TaskPool workers(1);
    FluidGrid grid(h);
    std::vector<FluidParticle> particles{at(-0.01f, 12.34f, -7.7f)};
    EXPECT_EQ(grid.cover(particles, {}, workers), 0u);
    for (int a = 0; a < 3; ++a) {
        const float cells = grid.in_cells(particles[0].position[a], a);
        EXPECT_GE(cells, static_cast<float>(FluidGrid::tile[a]));
        EXPECT_LE(cells, static_cast<float>(grid.size()[a] - FluidGrid::tile[a]));
        EXPECT_EQ(grid.size()[a] % FluidGrid::tile[a], 0);
    }
    const Cell c = cell_of(grid, particles[0]);
    const Vec3 center = grid.center(c);
    for (int a = 0; a < 3; ++a) {
        EXPECT_LE(std::fabs(center[a] - particles[0].position[a]), h / 2 + 1e-5);
        EXPECT_EQ(grid.index(c) + grid.stride(a), grid.index({c[0] + (a == 0), c[1] + (a == 1), c[2] + (a == 2)}));
    }
}

TEST(FluidGrid, ParticlesAreSortedByCellAsACountSays) {
    Random random(3);
    const LiquidBlock block(h, scatter(random, 12000, 1.2));
    const FluidGrid& grid = block.grid;
    ASSERT_EQ(grid.on_grid(), block.particles.size());
    std::set<std::uint32_t> ids;
    std::vector<std::uint32_t> counts(grid.row.size(), 0);
    for (const FluidParticle& particle : block.particles) {
        ids.insert(particle.id);
        ++counts[static_cast<std::size_t>(grid.index(cell_of(grid, particle)))];
    }
    EXPECT_EQ(ids.size(), 12000u);
    for (const Cell& corner : grid.tiles()) {
        grid.for_cells(corner, [&](int cell, const Cell& c) {
            ASSERT_EQ(cell, grid.index(c));
            ASSERT_EQ(grid.particle_count[cell], counts[cell]);
            for (std::uint32_t i = 0, last = 0; i < grid.particle_count[cell]; ++i) {
                const FluidParticle& particle = block.particles[grid.first_particle[cell] + i];
                ASSERT_EQ(cell_of(grid, particle), c);
                // Their order is that in which they came.
                ASSERT_TRUE(i == 0 || particle.id > last);
                last = particle.id;
            }
            counts[cell] = 0;
        });
    }
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0u), static_cast<std::ptrdiff_t>(counts.size()));
}

TEST(FluidGrid, TilesOfAColourAreNeverBesideEachOther) {
    Random random(4);
    const LiquidBlock block(h, scatter(random, 12000, 2));
    const FluidGrid& grid = block.grid;
    std::set<std::uint32_t> seen;
    for (int color = 0; color < FluidGrid::colors; ++color) {
        const auto tiles = grid.colored(color);
        for (const std::uint32_t a : tiles) {
            EXPECT_TRUE(seen.insert(a).second);
            for (const std::uint32_t b : tiles) {
                int apart = 0;
                for (int axis = 0; axis < 3; ++axis) {
                    apart = std::max(apart, std::abs(grid.tiles()[a][axis] - grid.tiles()[b][axis]) / grid.tile[axis]);
                }
                EXPECT_TRUE(a == b || apart > 1);
            }
        }
    }
    for (const FluidParticle& particle : block.particles) {
        const Cell c = cell_of(grid, particle);
        EXPECT_TRUE(grid.is_active(c));
        EXPECT_TRUE(std::ranges::any_of(
            seen, [&](std::uint32_t tile) { return grid.tile_of(grid.tiles()[tile]) == grid.tile_of(c); }));
    }
}

TEST(FluidGrid, DropsByThemselvesAreLeftOut) {
    std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {8, 8, 8});
    const std::size_t count = particles.size();
    for (int i = 0; i < 4; ++i) particles.push_back(at(4.0f + 3.0f * static_cast<float>(i), 0.5f, 0.5f));
    LiquidBlock block(h, particles);
    // Where the static obstacles are not known yet all meet the grid; then they are known.
    block.grid.sort(block.particles, LiquidBlock::particle_fraction, {}, {}, block.workers);
    EXPECT_EQ(block.grid.on_grid(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_LT(block.particles[i].position[0], 1);
    // But for what a moving obstacle may meet.
    const Bounds near{{3.9, 0.4, 0.4}, {4.1, 0.6, 0.6}};
    block.grid.sort(block.particles, LiquidBlock::particle_fraction, std::span(&near, 1), {}, block.workers);
    EXPECT_EQ(block.grid.on_grid(), count + 1);
}

TEST(FluidGrid, WhatIsKnownOfStaticObstaclesMovesWithTheBox) {
    TaskPool workers(1);
    FluidGrid grid(h);
    std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {4, 4, 4});
    grid.cover(particles, {}, workers);
    const Cell before = grid.lower();
    const auto place = [&](int x, int y, int z) {
        return grid.index({x - grid.lower()[0], y - grid.lower()[1], z - grid.lower()[2]});
    };
    grid.static_distance[place(1, 2, 3)] = -1.25f;
    grid.static_fraction[1][place(3, 0, 2)] = 0.75f;
    particles.push_back(at(-3, -2, 2.5f));
    EXPECT_EQ(grid.cover(particles, {}, workers), 0u);
    ASSERT_NE(grid.lower(), before);
    EXPECT_EQ(grid.static_distance[place(1, 2, 3)], -1.25f);
    EXPECT_EQ(grid.static_fraction[1][place(3, 0, 2)], 0.75f);
    EXPECT_EQ(std::count(grid.static_distance.begin(), grid.static_distance.end(), -1.25f), 1);
}

TEST(FluidGrid, AClearedTileHasNeitherLiquidNorMovingObstacle) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    const Cell corner = block.grid.tiles()[block.grid.tiles().size() / 2];
    block.grid.clear_tile(corner);
    block.grid.for_cells(corner, [&](int cell, const Cell&) {
        EXPECT_EQ(block.grid.row[cell], -1);
        EXPECT_EQ(block.grid.density[cell], 0);
        EXPECT_EQ(block.grid.obstacle_owner[cell], -1);
        EXPECT_GT(block.grid.surface[cell], 0);
        for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(block.grid.known[axis][cell], 0);
    });
}

TEST(FourNumbers, AreReadAndWrittenInTheOrderOfTheirPairs) {
    const float first[2] = {1, 2}, second[2] = {3, 4};
    Four four = load_pairs(first, second);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(four[i], static_cast<float>(i + 1));
    float a[2], b[2];
    store_pairs(four * 2.0f, a, b);
    EXPECT_EQ(a[0], 2);
    EXPECT_EQ(a[1], 4);
    EXPECT_EQ(b[0], 6);
    EXPECT_EQ(b[1], 8);
    const float row[5] = {0, 5, 6, 7, 8};
    four = load_four(row + 1);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(four[i], static_cast<float>(i + 5));
}

TEST(FluidParticles, ReachOfNoParticlesOrOfNonFiniteOnesIsInfinite) {
    TaskPool workers(1);
    EXPECT_EQ(reach_of({}, workers).farthest(), infinite);
    for (int i = 0; i < 6; ++i) {
        for (const float bad : {nan, infinite, -infinite}) {
            std::vector<FluidParticle> particles{at(1, 2, 3), at(-4, 5, 6)};
            (i < 3 ? particles[1].position[i] : particles[1].velocity[i - 3]) = bad;
            const ParticleReach reach = reach_of(particles, workers);
            EXPECT_FALSE(reach.is_finite());
            EXPECT_EQ(reach.farthest(), infinite);
        }
    }
}

TEST(FluidParticles, ReachIsTheBoxOfTheirPlaces) {
    Random random(5);
    for (const int number : {1, 3}) {
        TaskPool workers(number);
        const auto particles = scatter(random, 2500, 3);
        const ParticleReach reach = reach_of(particles, workers);
        float fastest = 0, farthest = 0;
        for (const FluidParticle& particle : particles) {
            float squared = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                EXPECT_GE(particle.position[a], reach.lower[a]);
                EXPECT_LE(particle.position[a], reach.upper[a]);
                squared += particle.velocity[a] * particle.velocity[a];
                farthest = std::max(farthest, std::fabs(particle.position[a]));
            }
            fastest = std::max(fastest, squared);
        }
        EXPECT_FLOAT_EQ(reach.fastest_squared, fastest);
        EXPECT_EQ(reach.farthest(), farthest);
    }
}

TEST(FluidParticles, UsualSpeedIgnoresTheFastestOneInSoMany) {
    TaskPool workers(1);
    EXPECT_EQ(usual_speed_of({}, 200, workers), 0);
    Random random(6);
    auto particles = scatter(random, 2000, 1);
    for (int i = 0; i < 9; ++i) particles[static_cast<std::size_t>(i) * 200].velocity[1] = 1000;
    std::vector<double> speeds;
    for (const FluidParticle& p : particles) {
        speeds.push_back(length(Vec3{p.velocity[0], p.velocity[1], p.velocity[2]}));
    }
    std::ranges::sort(speeds, std::greater{});
    // Ten of 2,000 may be faster: the eleventh is below it.
    const double usual = usual_speed_of(particles, 200, workers);
    EXPECT_GE(usual, speeds[10]);
    EXPECT_LE(usual, 1.011 * speeds[10]);
}

TEST(LiquidCells, SurfaceOfAFilledBlockLiesWhereItsParticlesEnd) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {8, 8, 8}));
    LiquidCells liquid;
    mark_liquid(block.grid, {}, liquid, block.workers);
    // Far from edges and corners: half a cell below and above the surface, exactly.
    const auto surface_at = [&](double y) { return block.grid.surface[block.index_at({0.45, y, 0.45})]; };
    EXPECT_NEAR(surface_at(0.75), -0.5, 1e-5);
    EXPECT_NEAR(surface_at(0.85), 0.5, 1e-5);
    EXPECT_NEAR(surface_at(0.05), -0.5, 1e-5);
    EXPECT_NEAR(surface_at(0.45), -1, 1e-3);  // it is told to a cell's depth
    EXPECT_NEAR(surface_at(1.15), 1, 1e-5);

    // Rows count the liquid cells, and cells and rows tell each other.
    ASSERT_EQ(liquid.first_row.size(), block.grid.tiles().size() + 1);
    EXPECT_EQ(liquid.first_row.front(), 0);
    EXPECT_EQ(liquid.first_row.back(), static_cast<int>(liquid.cells.size()));
    for (std::size_t row = 0; row < liquid.cells.size(); ++row) {
        EXPECT_EQ(block.grid.row[liquid.cells[row]], static_cast<int>(row));
        EXPECT_LT(block.grid.surface[liquid.cells[row]], 0);
    }
    std::size_t rows = 0;
    for (std::size_t tile = 0; tile < block.grid.tiles().size(); ++tile) {
        block.grid.for_cells(block.grid.tiles()[tile], [&](int cell, const Cell&) {
            const int row = block.grid.row[cell];
            rows += row >= 0;
            EXPECT_EQ(row >= 0, block.grid.surface[cell] < 0);
            EXPECT_TRUE(row < 0 || (row >= liquid.first_row[tile] && row < liquid.first_row[tile + 1]));
        });
    }
    EXPECT_EQ(rows, liquid.cells.size());
    // All but the corners and edges, whose particles fill less than half of the tent around their centres.
    EXPECT_GE(rows, 6u * 6 * 6 + 6u * 6 * 6);
    EXPECT_LE(rows, 8u * 8 * 8);
}

TEST(LiquidCells, OneParticleMakesNone) {
    LiquidBlock block(h, {at(0.5f, 0.5f, 0.5f)});
    LiquidCells liquid;
    mark_liquid(block.grid, {}, liquid, block.workers);
    EXPECT_TRUE(liquid.cells.empty());
}

// One of eight particles is left in 2 × 2 × 2 cells within a block, and then in the cells above them, too.
TEST(LiquidCells, ThinPocketsAreLiquidUnlessAirLeadsToThem) {
    for (const bool is_open : {false, true}) {
        std::vector<FluidParticle> particles = fill_cells(h, {0, 0, 0}, {12, 12, 12});
        std::erase_if(particles, [&](const FluidParticle& particle) {
            bool is_thin = true, is_kept = true;
            for (int axis = 0; axis < 3; ++axis) {
                const double cells = particle.position[axis] / h;
                is_thin = is_thin && cells > 5 && (cells < 7 || (is_open && axis == 1));
                is_kept = is_kept && cells - std::floor(cells) < 0.5;
            }
            return is_thin && !is_kept;
        });
        LiquidBlock block(h, std::move(particles));
        LiquidCells liquid;
        mark_liquid(block.grid, {}, liquid, block.workers);
        for (const double x : {0.55, 0.65}) {
            for (const double y : {0.55, 0.65}) {
                for (const double z : {0.55, 0.65}) {
                    const int cell = block.index_at({x, y, z});
                    EXPECT_LT(block.grid.density[cell], 0.5f);
                    EXPECT_EQ(block.grid.surface[cell] < 0, !is_open) << x << ' ' << y << ' ' << z;
                }
            }
        }
    }
}

}  // namespace
}  // namespace embody::physics::fluid
