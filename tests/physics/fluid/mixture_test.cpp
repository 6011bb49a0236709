// SPDX-License-Identifier: MIT
// Which particles are of which liquid, what faces know of it, and drops that settle.
#include "physics/fluid/particles/mixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "physics/fluid/liquid_block.h"
#include "physics/fluid/obstacles/small_body.h"
#include "physics/fluid/particles/settling.h"
#include "physics/fluid/pressure/pressure_system.h"
#include "physics/fluid/solver.h"

namespace embody::physics::fluid {
namespace {

constexpr double edge = 0.1;
const FluidProperties matter{.density = 1000, .viscosity = 0.001, .particle_volume = edge * edge * edge / 8};

FluidProperties like(double density, double viscosity = 0.001) {
    return {.density = density, .viscosity = viscosity, .particle_volume = matter.particle_volume};
}

TEST(Mixture, KnowsTheLiquidOfEachIdWhateverTheOrderOfAssignment) {
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        Mixture mixture(matter);
        std::vector<double> expected(100, 1000);
        for (int i = 0; i < 10; ++i) {
            const auto first = static_cast<std::uint32_t>(random.below(100));
            const auto last = first + static_cast<std::uint32_t>(random.below(101 - first));
            const double density = 500 + 100.0 * static_cast<double>(random.below(8));
            mixture.assign({first, last}, like(density));
            std::fill(expected.begin() + first, expected.begin() + last, density);
        }
        for (std::uint32_t id = 0; id < 100; ++id) EXPECT_EQ(mixture.of(id).density, expected[id]);
        std::uint32_t next = 10;
        for (const auto& [ids, liquid] : mixture.runs({10, 90})) {
            EXPECT_EQ(ids.first, next);
            for (std::uint32_t id = ids.first; id < ids.last; ++id)
                EXPECT_EQ(mixture.liquids()[liquid].density, expected[id]);
            next = ids.last;
        }
        EXPECT_EQ(next, 90u);
    }
}

TEST(Mixture, ForgetsLiquidsThatAreGone) {
    Mixture mixture(matter);
    mixture.assign({10, 20}, like(900));
    std::vector<FluidParticle> particles(1);
    particles[0].id = 12;
    mixture.keep_liquids_of(particles);
    EXPECT_TRUE(mixture.is_one());
    EXPECT_EQ(mixture.first().density, 900);
    EXPECT_EQ(mixture.of(12).density, 900);
}

// A block whose upper half is of another liquid.
struct TwoLayers {
    explicit TwoLayers(double density) : block(edge, fill_cells(edge, {0, 0, 0}, {8, 8, 8})) {
        mixture = matter;
        for (const FluidParticle& p : block.particles)
            if (p.position[1] > 0.4f) mixture.assign({p.id, p.id + 1}, like(density));
        mixture.identify(block.particles, block.workers);
        particles_to_grid(block.grid, block.particles, block.places, {LiquidBlock::particle_fraction, mixture},
                          block.workers);
    }
    Mixture mixture{matter};
    LiquidBlock block;
};

TEST(Mixture, FacesHaveTheDensityOfTheParticlesThere) {
    TwoLayers layers(250);
    const FluidGrid& grid = layers.block.grid;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(grid.relative_density(axis, layers.block.index_at({0.35, 0.15, 0.35})), 1, 1e-6);
        EXPECT_NEAR(grid.relative_density(axis, layers.block.index_at({0.35, 0.65, 0.35})), 0.25, 1e-6);
    }
    // The face between both layers has the mean: a fluid at rest has the pressure of the weight above.
    EXPECT_NEAR(grid.relative_density(1, layers.block.index_at({0.35, 0.45, 0.35})), 0.625, 1e-6);
    PressureSystem system;
    system.build(layers.block.grid, {}, layers.block.workers);
    EXPECT_TRUE(layers.mixture.is_top_heavy(grid, {0, 9.81, 0}));
    EXPECT_FALSE(layers.mixture.is_top_heavy(grid, {0, -9.81, 0}));
}

TEST(Mixture, ParticlesOfOneKindInTwoPartsAreOneLiquid) {
    const auto run = [](bool is_told_twice) {
        TaskPool workers(1);
        std::vector<Vec3f> places;
        for (const FluidParticle& p : fill_cells(edge, {0, 0, 0}, {6, 4, 6}))
            places.push_back({p.position[0], p.position[1], p.position[2]});
        FluidSolver solver({}, edge, matter, places, {0.1, 0, 0});
        if (is_told_twice) {
            solver.set_matter(FluidIds{100, 300}, like(500));
            solver.set_matter(FluidIds{100, 300}, matter);
        }
        for (int i = 0; i < 5; ++i) solver.advance(0.01, {0, -9.81, 0}, {}, workers);
        std::vector<float> found;
        for (const FluidParticle& p : solver.particles()) {
            found.insert(found.end(), p.position, p.position + 3);
            found.insert(found.end(), p.velocity, p.velocity + 3);
        }
        return found;
    };
    EXPECT_EQ(run(true), run(false));
}

// Blocks of different liquids that hit each other in free space.
TEST(Mixture, CollidingLiquidsKeepTheirMomentum) {
    Random random(8);
    for (int trial = 0; trial < 6; ++trial) {
        TaskPool workers(1);
        std::vector<Vec3f> places;
        for (const FluidParticle& p : fill_cells(edge, {0, 0, 0}, {8, 4, 4}))
            places.push_back({p.position[0], p.position[1], p.position[2]});
        FluidSolver solver({}, edge, matter, places, {});
        std::vector<std::uint32_t> right;
        for (const FluidParticle& p : solver.particles())
            if (p.position[0] > 0.4f) right.push_back(p.id);
        const FluidProperties other = like(random.between(200, 5000), random.between(0, 5));
        for (const std::uint32_t id : right) {
            solver.set_matter(FluidIds{id, id + 1}, other);
            solver.change_particles({id, id + 1}, [](std::uint32_t, Vec3&, Vec3& velocity) {
                velocity = {-1, 0.2, 0.1};
                return true;
            });
        }
        const Conserved before = solver.conserved({});
        for (int i = 0; i < 20; ++i) EXPECT_TRUE(solver.advance(0.01, {}, {}, workers).is_solved);
        const Conserved after = solver.conserved({});
        const double size = length(before.linear_momentum);
        EXPECT_LT(length(after.linear_momentum - before.linear_momentum), 1e-3 * size);
        EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 2e-3 * size);
        EXPECT_LT(after.kinetic_energy, before.kinetic_energy);
    }
}

TEST(Settling, IsAsFastAsTheDragOfASphereAllows) {
    Random random(5);
    for (int trial = 0; trial < 50; ++trial) {
        const double density = random.between(500, 14000), volume = std::exp(random.between(-20, -8));
        const Mixture::Around around{random.between(700, 1500), std::exp(random.between(-8, 4))};
        const double acceleration = random.between(0.1, 20);
        const double speed = settling_speed(density, volume, acceleration, around);
        const double radius = std::cbrt(volume * 0.75 / std::numbers::pi);
        const double drag = drag_of_sphere(radius, speed, around.density, around.viscosity) * speed;
        const double weight = std::fabs(density - around.density) * volume * acceleration;
        EXPECT_NEAR(drag, weight, 1e-9 * weight);
    }
    EXPECT_EQ(settling_speed(900, 1e-6, 0, {1000, 0.001}), 0);
    EXPECT_EQ(settling_speed(1000, 1e-6, 9.81, {1000, 0.001}), 0);
    EXPECT_TRUE(std::isfinite(settling_speed(900, 1e-6, 9.81, {1000, 0})));
}

// At a flat surface nothing settles, whichever way it lies; a single drop does, by its weight less its lift.
TEST(Settling, TakesDropsAndLeavesLayers) {
    TwoLayers layers(800);
    const Vec3 down{0, -9.81, 0};
    std::size_t drop = 0;
    for (std::size_t i = 0; i < layers.block.particles.size(); ++i) {
        float shift[3]{};
        settle(layers.block.grid, layers.mixture, i, layers.block.places[i].data(), down, 0.01, shift);
        const float y = layers.block.places[i][1];
        if (y > 0.1f && y < 0.7f) {
            EXPECT_EQ(shift[1], 0) << y;
        }
        const auto& place = layers.block.places[i];
        if (std::fabs(place[0] - 0.425f) < 0.01f && std::fabs(y - 0.225f) < 0.01f &&
            std::fabs(place[2] - 0.425f) < 0.01f)
            drop = i;
    }
    layers.mixture.assign({layers.block.particles[drop].id, layers.block.particles[drop].id + 1}, like(800));
    layers.mixture.identify(layers.block.particles, layers.block.workers);
    particles_to_grid(layers.block.grid, layers.block.particles, layers.block.places,
                      {LiquidBlock::particle_fraction, layers.mixture}, layers.block.workers);
    float shift[3]{};
    settle(layers.block.grid, layers.mixture, drop, layers.block.places[drop].data(), down, 0.01, shift);
    const double free = 0.01 * settling_speed(800, matter.particle_volume, 9.81, {1000, 0.001});
    EXPECT_GT(shift[1], 0.6 * free);
    EXPECT_LT(shift[1], free);
}

}  // namespace
}  // namespace embody::physics::fluid
