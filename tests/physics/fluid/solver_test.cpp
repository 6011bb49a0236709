// SPDX-License-Identifier: MIT
// Steps of a whole fluid without a world: what falls freely, what stands, what is refused.
#include "physics/fluid/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1, dt = 0.01;
const FluidProperties water{.density = 1000, .particle_volume = h * h * h / 8};

std::vector<Vec3f> places(Cell upper) {
    std::vector<Vec3f> positions;
    for (const FluidParticle& p : fill_cells(h, {0, 0, 0}, upper)) {
        positions.push_back({p.position[0], p.position[1], p.position[2]});
    }
    return positions;
}

TEST(FluidSolver, OfNothingDoesNothing) {
    TaskPool workers(1);
    FluidSolver solver({}, h, water, {}, {});
    solver.prepare({}, workers);
    const FluidOutcome outcome = solver.advance(dt, {0, -9.81, 0}, {}, workers);
    EXPECT_EQ(outcome.parts, 0);
    EXPECT_TRUE(outcome.is_finite && outcome.is_solved);
    EXPECT_EQ(solver.usual_speed(workers), 0);
    EXPECT_EQ(solver.pressure_at({0, 0, 0}), 0);
    EXPECT_EQ(solver.conserved({0, -9.81, 0}).kinetic_energy, 0);
}

TEST(FluidSolver, OneParticleFallsFreely) {
    TaskPool workers(1);
    const Vec3f place{0.5f, 0.5f, 0.5f};
    FluidSolver solver({7, 8, 9}, h, water, std::span(&place, 1), {1, 0, 0});
    for (int i = 0; i < 20; ++i) solver.advance(dt, {0, -9.81, 0}, {}, workers);
    ASSERT_EQ(solver.particles().size(), 1u);
    EXPECT_NEAR(solver.particles()[0].position[0], 0.7, 1e-4);
    EXPECT_NEAR(solver.particles()[0].velocity[1], -9.81 * 0.2, 1e-4);
    EXPECT_NEAR(solver.conserved({}).linear_momentum.x, 1000 * h * h * h / 8, 1e-6);
}

TEST(FluidSolver, NonFiniteNumbersAreReported) {
    TaskPool workers(1);
    const auto shape = CollisionShape::create(BoxShape{{0.2, 0.2, 0.2}}).value();
    FluidObstacle box{.shape = shape.get(), .pose = {{0.4, -0.2, 0.4}, {}}, .center = {0.4, -0.2, 0.4}};
    FluidSolver solver({}, h, water, places({8, 8, 8}), {});
    solver.change_particles({0, 1}, [](std::uint32_t, Vec3&, Vec3& velocity) {
        velocity.x = std::numeric_limits<double>::quiet_NaN();
        return true;
    });
    const FluidOutcome outcome = solver.advance(dt, {0, -9.81, 0}, std::span(&box, 1), workers);
    EXPECT_FALSE(outcome.is_finite);
    EXPECT_EQ(box.impulse, Vec3{});
}

// A constant velocity is advected as it is: the block moves as one, and gravity moves it on a parabola.
TEST(FluidSolver, ABlockInFreeFlightMovesAsOne) {
    TaskPool workers(1);
    for (const Vec3 gravity : {Vec3{}, Vec3{0, -9.81, 0}}) {
        const Vec3 velocity{0.5, 1, -0.3};
        FluidSolver solver({}, h, water, places({6, 6, 6}), velocity);
        std::vector<Vec3> before(solver.particles().size());
        for (const FluidParticle& p : solver.particles()) {
            before[p.id] = {p.position[0], p.position[1], p.position[2]};
        }
        const Conserved start = solver.conserved(gravity);
        constexpr int steps = 10;
        for (int i = 0; i < steps; ++i) {
            const FluidOutcome outcome = solver.advance(dt, gravity, {}, workers);
            EXPECT_TRUE(outcome.is_finite && outcome.is_solved && !outcome.is_slowed);
            EXPECT_EQ(outcome.lost, 0u);
        }
        const double t = steps * dt;
        ASSERT_EQ(solver.particles().size(), before.size());
        // Symplectic Euler: half a step more of gravity's way.
        const Vec3 displacement = velocity * t + gravity * (t * (t + dt) / 2);
        for (const FluidParticle& p : solver.particles()) {
            const Vec3 now{p.position[0], p.position[1], p.position[2]};
            EXPECT_LT(length(now - before[p.id] - displacement), 2e-3 * h);
        }
        const Conserved end = solver.conserved(gravity);
        const double mass = 1000 * 0.6 * 0.6 * 0.6;
        EXPECT_LT(length(end.linear_momentum - start.linear_momentum - gravity * (mass * t)), 1e-3 * mass);
    }
}

TEST(FluidSolver, ATurningBlockKeepsBothMomenta) {
    TaskPool workers(1);
    FluidSolver solver({}, h, water, places({6, 6, 6}), {});
    const Vec3 middle{0.3, 0.3, 0.3}, spin{0, 0, 2};
    solver.change_particles({0, 1u << 30}, [&](std::uint32_t, Vec3& p, Vec3& velocity) {
        velocity = Vec3{0, 0, 0.4} + cross(spin, p - middle);
        return true;
    });
    const Conserved start = solver.conserved({});
    for (int i = 0; i < 10; ++i) solver.advance(dt, {}, {}, workers);
    const Conserved end = solver.conserved({});
    EXPECT_LT(length(end.linear_momentum - start.linear_momentum), 1e-3 * length(start.linear_momentum));
    EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 0.05 * length(start.angular_momentum));
    EXPECT_LE(end.kinetic_energy, start.kinetic_energy * 1.005);
}

TEST(FluidSolver, StandingWaterPressesByItsDepthAndCarriesNothingAway) {
    TaskPool workers(1);
    std::vector<std::unique_ptr<CollisionShape>> shapes;
    std::vector<FluidObstacle> walls;
    const auto add = [&](Vec3 half, Vec3 center) {
        shapes.push_back(CollisionShape::create(BoxShape{half}).value());
        walls.push_back({.body = static_cast<std::uint32_t>(walls.size()),
                         .shape = shapes.back().get(),
                         .is_static = true,
                         .pose = {center, {}},
                         .center = center});
    };
    add({2, 0.4, 2}, {0.4, -0.4, 0.4});
    for (const double x : {-0.4, 1.2}) add({0.4, 2, 2}, {x, 1, 0.4});
    for (const double z : {-0.4, 1.2}) add({2, 2, 0.4}, {0.4, 1, z});
    FluidSolver solver({}, h, water, places({8, 6, 8}), {});
    solver.prepare(walls, workers);
    for (int i = 0; i < 5; ++i) {
        const FluidOutcome outcome = solver.advance(dt, {0, -9.81, 0}, walls, workers);
        EXPECT_TRUE(outcome.is_finite && outcome.is_solved);
        EXPECT_EQ(outcome.parts, 1);
    }
    EXPECT_LT(solver.usual_speed(workers), 0.02);
    for (const double y : {0.05, 0.15, 0.25, 0.35, 0.45}) {
        EXPECT_NEAR(solver.pressure_at({0.45, y, 0.45}), 1000 * 9.81 * (0.6 - y), 100);
    }
    EXPECT_EQ(solver.pressure_at({0.45, 1.5, 0.45}), 0);
    EXPECT_EQ(solver.pressure_at({0.45, -50, 0.45}), 0);
    const FluidSolver::Followed followed = solver.follow(walls, workers);
    EXPECT_TRUE(followed.is_solved);
    EXPECT_EQ(followed.lost, 0u);
    EXPECT_EQ(solver.particles().size(), 8u * 6 * 8 * 8);
}

TEST(FluidSolver, ABodyIsGivenWhatTheLiquidLoses) {
    TaskPool workers(1);
    const auto shape = CollisionShape::create(BoxShape{{0.2, 0.2, 0.2}}).value();
    constexpr double mass = 50;
    FluidObstacle box{.shape = shape.get(), .pose = {{0.4, -0.25, 0.4}, {}}, .center = {0.4, -0.25, 0.4}};
    box.inverse_mass = 1 / mass;
    box.inverse_inertia = Mat3::identity() * (6 / (mass * 0.16));
    box.linear_velocity = {0, 2, 0};
    FluidSolver solver({}, h, water, places({8, 8, 8}), {});
    double given = 0;
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(solver.advance(dt, {}, std::span(&box, 1), workers).is_finite);
        given += box.impulse.y;
        box.linear_velocity += box.impulse / mass;
        box.angular_velocity += box.inverse_inertia * box.angular_impulse;
        box.center += box.linear_velocity * dt;
        box.pose.position = box.center;
    }
    EXPECT_LT(given, -5);
    EXPECT_NEAR(solver.conserved({}).linear_momentum.y, -given, 0.01 * -given);
}

TEST(FluidSolver, ParticlesComeAndGoByTheirIds) {
    TaskPool workers(1);
    FluidSolver solver({1, 2, 3}, h, water, places({2, 2, 2}), {0, 1, 0});
    EXPECT_EQ(solver.particles().size(), 64u);
    const std::vector<Vec3f> more{{0.5f, 0.5f, 0.5f}, {0.6f, 0.5f, 0.5f}};
    const FluidIds added = solver.add_particles(more);
    EXPECT_EQ(added.first, 64u);
    EXPECT_EQ(added.last, 66u);
    const auto taken = solver.take_particles({10, 20});
    ASSERT_EQ(taken.size(), 10u);
    for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i].id, 10 + i);
    EXPECT_EQ(solver.particles().size(), 56u);
    // Back from another frame: to the same places of the world.
    const FluidIds again = solver.add_particles(taken, {0, 2, 3});
    EXPECT_EQ(again.first, 66u);
    EXPECT_EQ(again.last, 76u);
    const FluidParticle& last = solver.particles().back();
    EXPECT_NEAR(last.position[0] + 1, taken.back().position[0], 1e-6);
    EXPECT_EQ(last.velocity[1], 1);
    std::set<std::uint32_t> ids;
    for (const FluidParticle& p : solver.particles()) ids.insert(p.id);
    EXPECT_EQ(ids.size(), solver.particles().size());
    // Some away, some changed.
    solver.change_particles({66, 76}, [&](std::uint32_t id, Vec3& position, Vec3&) {
        position.y += 1;
        return id != 70;
    });
    EXPECT_EQ(solver.particles().size(), 65u);
    solver.stop();
    EXPECT_EQ(solver.conserved({}).kinetic_energy, 0);
    const std::vector<std::uint32_t> names{5, 6};
    solver.put_at_rest(more, names);
    ASSERT_EQ(solver.particles().size(), 2u);
    EXPECT_EQ(solver.particles()[1].id, 6u);
    FluidProperties honey = water;
    honey.viscosity = 10;
    honey.particle_volume = 5;
    solver.set_matter(honey);
    EXPECT_EQ(solver.properties().viscosity, 10);
    EXPECT_EQ(solver.properties().particle_volume, water.particle_volume);
}

}  // namespace
}  // namespace embody::physics::fluid
