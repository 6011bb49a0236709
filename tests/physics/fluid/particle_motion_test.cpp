// SPDX-License-Identifier: MIT
// Particles that move: kept out of obstacles, slowed at walls as drops, and components of them that keep their momenta.
#include "physics/fluid/particles/collide_particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/particles/drops.h"
#include "physics/fluid/particles/free_components.h"
#include "physics/fluid/pressure/pressure_system.h"
#include "physics/fluid/solver.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1, dt = 0.01;

Vec3 position_of(const FluidParticle& p) { return {p.position[0], p.position[1], p.position[2]}; }
Vec3 velocity_of(const FluidParticle& p) { return {p.velocity[0], p.velocity[1], p.velocity[2]}; }
Vec3 any_point(Random& random, double low, double high) {
    return {random.between(low, high), random.between(low, high), random.between(low, high)};
}
FluidParticle at(Vec3 p, Vec3 v = {}) {
    FluidParticle particle;
    for (int a = 0; a < 3; ++a) {
        particle.position[a] = static_cast<float>(p[a]);
        particle.velocity[a] = static_cast<float>(v[a]);
    }
    return particle;
}
void move(ParticleCollider& collider, FluidParticle& particle, Vec3 to) {
    const float end[3] = {static_cast<float>(to.x), static_cast<float>(to.y), static_cast<float>(to.z)};
    collider.move(particle, end);
}

TEST(ParticleCollider, WithoutObstaclesAllGoWhereTheyWant) {
    Random random(1);
    const LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}));
    ParticleCollider collider(block.grid, block.obstacles, {}, dt);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 from = any_point(random, 0.3, 0.9), to = from + any_point(random, -0.2, 0.2);
        FluidParticle particle = at(from, {1, 2, 3});
        EXPECT_FALSE(collider.is_near_thin(particle.position));
        const auto place = collider.place_of(particle);
        for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(place[a], particle.position[a]);
        move(collider, particle, to);
        EXPECT_LT(length(position_of(particle) - to), 1e-6);
        EXPECT_EQ(velocity_of(particle), (Vec3{1, 2, 3}));
    }
}

TEST(ParticleCollider, NothingEntersASolid) {
    Random random(2);
    const auto ball = CollisionShape::create(SphereShape{0.3}).value();
    const auto box = CollisionShape::create(BoxShape{{0.25, 0.3, 0.2}}).value();
    for (const CollisionShape* shape : {ball.get(), box.get()}) {
        for (const bool is_static : {true, false}) {
            FluidObstacle solid{.shape = shape, .is_static = is_static, .pose = {{0.6, 0.6, 0.6}, {}}};
            solid.center = solid.pose.position;
            const LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}), std::span(&solid, 1));
            ParticleCollider collider(block.grid, block.obstacles, {}, dt);
            ObstacleProbe probe(*shape, solid.pose, {});
            probe.look_at({{-2, -2, -2}, {2, 2, 2}}, 5);
            int stopped = 0;
            for (int trial = 0; trial < 600; ++trial) {
                const Vec3 from = any_point(random, 0.05, 1.15);
                if (probe.nearest(from).distance < 0.01 || probe.nearest(from).distance > 0.1) continue;
                const Vec3 to = from + normalized(any_point(random, -1, 1)) * random.between(0.01, 0.15);
                FluidParticle particle = at(from, (to - from) / dt);
                move(collider, particle, to);
                // By the grid's distances, which round edges off by less than a third of a cell.
                EXPECT_GT(probe.nearest(position_of(particle)).distance, -0.3 * h);
                stopped += length(position_of(particle) - to) > 1e-3;
            }
            EXPECT_GT(stopped, 3);
        }
    }
}

TEST(ParticleCollider, NothingPassesAWallThinnerThanACell) {
    Random random(3);
    const auto shape = CollisionShape::create(BoxShape{{2, 0.004, 2}}).value();
    for (const bool is_static : {true, false}) {
        FluidObstacle wall{.shape = shape.get(), .is_static = is_static};
        wall.pose.position = wall.center = {0.6, 0.63, 0.6};
        const LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}), std::span(&wall, 1));
        ParticleCollider collider(block.grid, block.obstacles, {}, dt);
        for (int trial = 0; trial < 400; ++trial) {
            const Vec3 from = any_point(random, 0.45, 0.8);
            const double side = from.y - 0.63;
            if (std::fabs(side) < 0.005) continue;
            const Vec3 to = from + any_point(random, -0.3, 0.3);
            FluidParticle particle = at(from, (to - from) / dt);
            EXPECT_TRUE(collider.is_near_thin(particle.position));
            // It meets the grid on its own side, too.
            EXPECT_GE((collider.place_of(particle)[1] - 0.63f) * side, 0);
            move(collider, particle, to);
            EXPECT_GT((particle.position[1] - 0.63f) * side, 0);
            // What ended there goes no further in.
            const bool is_stopped = (to.y - 0.63) * side < 0;
            if (is_stopped) {
                EXPECT_GE(particle.velocity[1] * side, -1e-4);
            }
        }
    }
}

TEST(Drops, AreParticlesWithoutALiquidCellBesideThem) {
    auto particles = fill_cells(h, {0, 0, 0}, {8, 8, 8});
    LiquidBlock block(h, particles);
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    const float inside[3] = {0.45f, 0.45f, 0.45f}, beside[3] = {0.45f, 0.85f, 0.45f}, away[3] = {0.45f, 0.95f, 0.45f};
    EXPECT_FALSE(is_drop(block.grid, inside));
    EXPECT_FALSE(is_drop(block.grid, beside));
    EXPECT_TRUE(is_drop(block.grid, away));
}

struct Floor {
    std::unique_ptr<CollisionShape> shape = CollisionShape::create(BoxShape{{3, 0.4, 3}}).value();
    FluidObstacle floor{.shape = shape.get(), .is_static = true, .pose = {{0.6, -0.4, 0.6}, {}}};
    LiquidBlock block{h, fill_cells(h, {0, 0, 0}, {12, 4, 12}), std::span(&floor, 1)};
    FluidProperties liquid{.density = 1000, .viscosity = 0, .particle_volume = h * h * h / 8};
    Vec3 slowed(Vec3 place, Vec3 velocity) const {
        FluidParticle drop = at(place, velocity);
        slow_at_wall({block.grid, block.obstacles, {}, dt}, liquid, drop.position, drop.velocity);
        return velocity_of(drop);
    }
};

TEST(Drops, AreSlowedByAFilmsStressAtAWallAlone) {
    Floor floor;
    const Vec3 at_wall{0.62, 0.01, 0.61}, away{0.62, 0.1, 0.61};
    // A film of no viscosity is slowed by nothing but what turbulence does, which is nothing then.
    EXPECT_NEAR(floor.slowed(at_wall, {1, 0, 0}).x, 1, 1e-3);
    floor.liquid.viscosity = 20;
    const double thickness = floor.liquid.particle_volume / (h * h);
    const double kept = 1 / (1 + 3 * 20 / 1000.0 * dt / (thickness * thickness));
    const Vec3 slow = floor.slowed(at_wall, {0.3, -0.2, 0.4});
    EXPECT_NEAR(slow.x, 0.3 * kept, 1e-5);
    EXPECT_NEAR(slow.z, 0.4 * kept, 1e-5);
    EXPECT_NEAR(slow.y, -0.2, 1e-6);  // the wall itself sees to that
    EXPECT_EQ(floor.slowed(away, {1, 0, 0}).x, 1);
    EXPECT_EQ(floor.slowed(at_wall, {}).x, 0);
}

TEST(Drops, StayWhereTheirRimOrTheirYieldStressHoldsThem) {
    Floor floor;
    const Vec3 at_wall{0.62, 0.01, 0.61};
    floor.liquid.surface_tension = 0.07;
    const double lost = 0.4 * 0.07 / (1000 * h * h / 4) * dt;
    EXPECT_NEAR(floor.slowed(at_wall, {1, 0, 0}).x, 1 - lost, 1e-4);
    EXPECT_EQ(floor.slowed(at_wall, {lost / 2, 0, 0}).x, 0);
    floor.liquid.surface_tension = 0;
    floor.liquid.yield_stress = 100;
    const double by_yield = 100 / 1000.0 / (h / 8) * dt;
    EXPECT_NEAR(floor.slowed(at_wall, {1, 0, 0}).x, 1 - by_yield, 1e-4);
    EXPECT_EQ(floor.slowed(at_wall, {by_yield / 2, 0, by_yield / 2}).x, 0);
}

// What was done to the particles of a free component as a whole is undone.
TEST(FreeComponents, KeepTheirMomentumAndAngularMomentum) {
    Random random(4);
    auto particles = fill_cells(h, {0, 0, 0}, {6, 6, 6});
    auto other = fill_cells(h, {16, 0, 0}, {22, 6, 6});
    particles.insert(particles.end(), other.begin(), other.end());
    for (FluidParticle& particle : particles) {
        for (float& v : particle.velocity) v = static_cast<float>(random.between(-1, 1));
    }
    LiquidBlock block(h, particles);
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    FreeComponents components;
    const Mixture liquid(FluidProperties{.density = 1, .particle_volume = 1});
    components.begin(block.grid, system, block.obstacles, {}, block.particles, {.liquids = liquid, .all = true});
    const auto momenta = [&](bool is_first) {
        Vec3 place, linear, angular;
        double count = 0;
        for (const FluidParticle& p : block.particles) {
            if ((p.position[0] < 1) != is_first) continue;
            place += position_of(p);
            ++count;
        }
        for (const FluidParticle& p : block.particles) {
            if ((p.position[0] < 1) != is_first) continue;
            linear += velocity_of(p);
            angular += cross(position_of(p) - place / count, velocity_of(p));
        }
        return std::pair(linear, angular);
    };
    const auto first = momenta(true), second = momenta(false);
    for (FluidParticle& p : block.particles) {
        const Vec3 push =
            p.position[0] < 1 ? Vec3{0.3, -0.1, 0.2} + cross(Vec3{1, 2, -1}, position_of(p)) : Vec3{-1, 0.5, 0};
        for (int a = 0; a < 3; ++a) p.velocity[a] += static_cast<float>(push[a]);
    }
    const Vec3 gravity{0, -0.1, 0};
    const std::vector<std::uint8_t> stopped(block.particles.size(), 0);
    components.end(gravity, block.obstacles, {}, liquid, stopped, block.particles);
    const auto first_after = momenta(true), second_after = momenta(false);
    const double count = static_cast<double>(block.particles.size()) / 2;
    EXPECT_LT(length(first_after.first - first.first - gravity * count), 1e-3 * count);
    EXPECT_LT(length(second_after.first - second.first - gravity * count), 1e-3 * count);
    EXPECT_LT(length(first_after.second - first.second), 2e-3 * count);
    EXPECT_LT(length(second_after.second - second.second), 2e-3 * count);
}

// A block that flies, the lowest particle of which has met a floor: what that took is not put back on the others.
TEST(FreeComponents, WhatIsStoppedOnItsPathIsNotFree) {
    LiquidBlock block(h, fill_cells(h, {0, 0, 0}, {6, 6, 6}));
    PressureSystem system;
    system.build(block.grid, {}, block.workers);
    const Mixture liquid(FluidProperties{.density = 1, .particle_volume = 1});
    for (const std::uint8_t is_stopped : {0, 1}) {
        FreeComponents components;
        for (FluidParticle& p : block.particles) p.velocity[1] = -1;
        components.begin(block.grid, system, block.obstacles, {}, block.particles, {.liquids = liquid, .all = true});
        std::vector<std::uint8_t> stopped(block.particles.size(), 0);
        stopped.front() = is_stopped;
        block.particles.front().velocity[1] = 0;
        components.end({}, block.obstacles, {}, liquid, stopped, block.particles);
        double sum = 0;
        for (const FluidParticle& p : block.particles) sum += p.velocity[1];
        const auto count = static_cast<double>(block.particles.size());
        EXPECT_NEAR(sum, is_stopped ? 1 - count : -count, 1e-3);
        if (is_stopped) EXPECT_EQ(block.particles.back().velocity[1], -1);
    }
}

TEST(FreeComponents, WhatStandsOnTheGroundIsNotFree) {
    Floor floor;
    PressureSystem system;
    system.build(floor.block.grid, {}, floor.block.workers);
    FreeComponents components;
    const Mixture liquid(floor.liquid);
    components.begin(floor.block.grid, system, floor.block.obstacles, {}, floor.block.particles,
                     {.liquids = liquid, .all = true});
    for (FluidParticle& p : floor.block.particles) p.velocity[0] = 3;
    const std::vector<std::uint8_t> stopped(floor.block.particles.size(), 0);
    components.end({}, floor.block.obstacles, {}, liquid, stopped, floor.block.particles);
    for (const FluidParticle& p : floor.block.particles) EXPECT_EQ(p.velocity[0], 3);
}

}  // namespace
}  // namespace embody::physics::fluid
