// SPDX-License-Identifier: MIT
// A fluid through the world: what it refuses, momentum, equal bits, sleep.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "make_world.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/inter/world.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/stages/stages.h"
#include "physics/state/world_state.h"

namespace embody::physics::fluid {
namespace {

using namespace state;
using namespace stages;

BodyHandle add_box(World& world, Vec3 half_extents, BodyDefinition definition) {
    definition.shape = world.create_shape(BoxShape{half_extents}).value();
    return world.create_body(definition).value();
}

FluidDefinition cube_of_water(double edge, double cell) {
    return {.boxes = {{{0, 0, 0}, {edge, edge, edge}}}, .cell_size = cell};
}

// Four walls and a floor around the unit square.
void add_basin(World& world) {
    add_box(world, {2, 0.5, 2}, {.kind = BodyKind::static_body, .position = {0.5, -0.5, 0.5}});
    for (const double x : {-0.5, 1.5})
        add_box(world, {0.5, 2, 2}, {.kind = BodyKind::static_body, .position = {x, 1, 0.5}});
    for (const double z : {-0.5, 1.5})
        add_box(world, {0.5, 2, 0.5}, {.kind = BodyKind::static_body, .position = {0.5, 1, z}});
}

TEST(Fluid, DefinitionsThatMakeNoSenseAreRefusedByField) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto field = [](FluidDefinition definition) {
        auto world = make_world();
        const auto fluid = world->create_fluid(definition);
        EXPECT_TRUE(world->fluids().empty());
        return fluid ? std::string("accepted") : fluid.error().where;
    };
    EXPECT_EQ(field({}), "boxes");
    const FluidDefinition good = cube_of_water(0.1, 0.02);
    const auto with = [&](auto change) {
        FluidDefinition definition = good;
        change(definition);
        return definition;
    };
    EXPECT_EQ(field(with([](auto& d) { d.boxes[0].upper.y = 0; })), "boxes[0]");
    EXPECT_EQ(field(with([](auto& d) { d.boxes[0].lower.x = nan; })), "boxes[0].lower.x");
    EXPECT_EQ(field(with([](auto& d) { d.density = 0; })), "density");
    EXPECT_EQ(field(with([](auto& d) { d.viscosity = -1; })), "viscosity");
    EXPECT_EQ(field(with([](auto& d) { d.yield_stress = nan; })), "yield_stress");
    EXPECT_EQ(field(with([](auto& d) { d.cell_size = 0; })), "cell_size");
    EXPECT_EQ(field(with([](auto& d) { d.cell_size = 1e-300; })), "cell_size");
    EXPECT_EQ(field(with([](auto& d) { d.boxes[0].upper = {100, 100, 100}; })), "cell_size");
    EXPECT_EQ(field(with([](auto& d) { d.velocity.z = 1e300; })), "velocity.z");
    EXPECT_EQ(field(with([](auto& d) { d.hulls = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}; })), "hulls[0]");
    EXPECT_EQ(field(with([](auto& d) { d.points = {{0, nan, 0}}; })), "points[0].y");
}

TEST(Fluid, StaleHandlesAreRefused) {
    auto world = make_world();
    const FluidHandle water = world->create_fluid(cube_of_water(0.1, 0.02)).value();
    EXPECT_EQ(world->fluids().size(), 1u);
    ASSERT_TRUE(world->destroy_fluid(water));
    EXPECT_FALSE(world->destroy_fluid(water));
    EXPECT_FALSE(world->set_fluid(water, cube_of_water(0.1, 0.02)));
    EXPECT_EQ(world->fluid(water), nullptr);
    EXPECT_TRUE(world->fluid_particles(water).positions.empty());
}

TEST(Fluid, MatterCanChangeWhileItRunsButNotItsCells) {
    auto world = make_world();
    FluidDefinition definition = cube_of_water(0.1, 0.02);
    const FluidHandle water = world->create_fluid(definition).value();
    definition.viscosity = 50;
    EXPECT_TRUE(world->set_fluid(water, definition));
    EXPECT_EQ(world->fluid(water)->viscosity, 50);
    definition.cell_size = 0.03;
    const auto refused = world->set_fluid(water, definition);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "cell_size");
}

TEST(Fluid, ParticlesFillTheVolumeButNoObstacle) {
    auto world = make_world();
    add_box(*world, {0.05, 1, 1}, {.kind = BodyKind::static_body, .position = {0.05, 0, 0}});
    const FluidHandle water = world->create_fluid(cube_of_water(0.2, 0.02)).value();
    const FluidParticles particles = world->fluid_particles(water);
    EXPECT_NEAR(particles.particle_volume * static_cast<double>(particles.positions.size()), 0.2 * 0.2 * 0.1, 1e-9);
    for (const Vec3f p : particles.positions) EXPECT_GT(particles.origin.x + Vec3(p).x, 0.1);
}

TEST(Fluid, APartGoesOnInAnotherFluid) {
    auto world = make_world({.gravity = {0, 0, 0}});
    FluidDefinition definition = cube_of_water(0.2, 0.04);
    definition.boxes.push_back({{0.5, 0, 0}, {0.7, 0.2, 0.2}});
    definition.velocity = {0, 1, 0};
    const FluidHandle first = world->create_fluid(definition).value();
    for (int i = 0; i < 5; ++i) world->step();
    const double mass = definition.density * 2 * 0.2 * 0.2 * 0.2;
    const auto is_as_before = [&] {
        std::size_t count = 0;
        for (const FluidHandle fluid : world->fluids()) count += world->fluid_particles(fluid).ids.size();
        EXPECT_EQ(count, 2000u);
        EXPECT_NEAR(world->conserved().linear_momentum.y, mass, 1e-3 * mass);
    };
    const FluidPart own = world->move_between_fluids(first, {1000, 2000}).value();
    EXPECT_EQ(own.ids.last - own.ids.first, 1000u);
    EXPECT_EQ(world->fluids().size(), 2u);
    EXPECT_GT(world->fluid_particles(own.fluid).bounds.lower.x, 0.45);
    EXPECT_LT(world->fluid_particles(first).bounds.upper.x, 0.25);
    is_as_before();
    for (int i = 0; i < 5; ++i) world->step();
    is_as_before();
    const FluidPart back = world->move_between_fluids(own.fluid, own.ids, first).value();
    EXPECT_EQ(back.ids.first, 2000u);
    is_as_before();
    EXPECT_TRUE(world->fluid_particles(own.fluid).ids.empty());
    for (int i = 0; i < 5; ++i) world->step();
    is_as_before();

    const FluidHandle coarse = world->create_fluid(cube_of_water(0.2, 0.05)).value();
    EXPECT_EQ(world->move_between_fluids(first, {0, 1000}, coarse).error().where, "to");
    EXPECT_EQ(world->move_between_fluids(first, {0, 1000}, first).error().where, "to");
    ASSERT_TRUE(world->destroy_fluid(coarse));
    EXPECT_EQ(world->move_between_fluids(coarse, {0, 1000}).error().where, "from");
}

TEST(Fluid, LiquidInFreeFallKeepsItsMomentumButForGravity) {
    for (const double viscosity : {0.0, 20.0}) {
        auto world = make_world();
        FluidDefinition definition = cube_of_water(0.2, 0.02);
        definition.viscosity = viscosity;
        definition.velocity = {1, 2, -0.5};
        const FluidHandle water = world->create_fluid(definition).value();
        const double mass = definition.density * 0.2 * 0.2 * 0.2;
        constexpr int steps = 30;
        for (int i = 0; i < steps; ++i) world->step();
        const Vec3 momentum = world->conserved().linear_momentum;
        EXPECT_NEAR(momentum.x, mass * 1, 1e-3 * mass) << viscosity;
        EXPECT_NEAR(momentum.y, mass * (2 - 9.81 * steps / 60), 1e-3 * mass) << viscosity;
        EXPECT_NEAR(momentum.z, mass * -0.5, 1e-3 * mass) << viscosity;
        EXPECT_EQ(world->fluid_particles(water).positions.size(), 8000u);
    }
}

// A box thrown into a floating component: what one loses the other gains.
TEST(Fluid, MomentumGoesFromBodyToLiquid) {
    for (const double viscosity : {0.0, 5.0}) {
        auto world = make_world({.gravity = {0, 0, 0}});
        FluidDefinition definition = cube_of_water(0.3, 0.03);
        definition.viscosity = viscosity;
        ASSERT_TRUE(world->create_fluid(definition));
        const BodyHandle box =
            add_box(*world, {0.06, 0.06, 0.06}, {.position = {-0.1, 0.15, 0.15}, .linear_velocity = {2, 0, 0}});
        const double before = world->conserved().linear_momentum.x;
        for (int i = 0; i < 20; ++i) world->step();
        EXPECT_LT(world->linear_velocity(box).x, 1.5) << viscosity;
        EXPECT_NEAR(world->conserved().linear_momentum.x, before, 0.01 * before) << viscosity;
    }
}

TEST(Fluid, EqualBitsForAnyNumberOfWorkers) {
    const auto hash = [](int workers) {
        auto world = make_world({.workers = workers});
        add_basin(*world);
        FluidDefinition definition{.boxes = {{{0, 0, 0}, {0.4, 0.6, 1}}}, .viscosity = 3, .cell_size = 0.06};
        EXPECT_TRUE(world->create_fluid(definition));
        add_box(*world, {0.1, 0.1, 0.1}, {.position = {0.7, 0.4, 0.5}, .mass = {.density = 500}});
        for (int i = 0; i < 40; ++i) world->step();
        return world->state_hash();
    };
    const std::uint64_t one = hash(1);
    for (const int workers : {1, 2, 3, 4}) EXPECT_EQ(hash(workers), one) << workers;
}

TEST(Fluid, ALeakIsReportedAndNumbersStayFinite) {
    auto world = make_world({.time_step = 0.05});
    FluidDefinition definition = cube_of_water(0.2, 0.02);
    definition.velocity = {1000, 0, 0};
    const FluidHandle water = world->create_fluid(definition).value();
    std::uint32_t limits = 0;
    for (int i = 0; i < 5; ++i) limits |= world->step().limits;
    EXPECT_NE(limits & static_cast<std::uint32_t>(StepLimit::fluid_too_fast), 0u);
    for (const Vec3f p : world->fluid_particles(water).positions) ASSERT_TRUE(is_finite(Vec3(p)));
    EXPECT_TRUE(std::isfinite(world->conserved().kinetic_energy));
}

// A fluid whose particles have that velocity, which no definition allows.
FluidRecord fluid_gone_wrong(const ObstacleAccess& world, const FluidDefinition& definition, Vec3 velocity) {
    FluidRecord record = set_up_fluid(world, definition).value();
    std::vector<Vec3f> places = record.positions;
    record.solver = std::make_unique<FluidSolver>(record.solver->origin(), definition.cell_size,
                                                  record.solver->properties(), places, velocity);
    return record;
}

TEST(Fluid, NonFiniteNumbersFreezeItAndAreReported) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const Vec3 velocity : {Vec3{nan, 0, 0}, Vec3{0, -inf, 0}, Vec3{3e38, 3e38, 0}}) {
        WorldState world;
        const FluidHandle water =
            world.fluids.records.insert(fluid_gone_wrong(ObstacleAccess(world), cube_of_water(0.2, 0.02), velocity));
        const std::vector<Vec3f> before = world.fluids.records.find(water)->positions;
        for (int i = 0; i < 3; ++i) {
            advance_fluids(FluidAccess(world));
            EXPECT_NE(world.report.limits & static_cast<std::uint32_t>(StepLimit::not_finite_fluid_frozen), 0u);
            const FluidRecord& record = *world.fluids.records.find(water);
            EXPECT_TRUE(record.is_frozen);
            ASSERT_EQ(record.positions.size(), before.size());
            for (std::size_t k = 0; k < before.size(); ++k) {
                ASSERT_EQ(record.positions[k].x, before[k].x);
                ASSERT_EQ(record.velocities[k].x, 0);
            }
        }
    }
}

TEST(Fluid, NonFiniteNumbersPushNoBody) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto shape = std::move(CollisionShape::create(BoxShape{{0.05, 0.05, 0.05}})).value();
    FluidObstacle obstacle{.shape = shape.get(), .inverse_mass = 1, .inverse_inertia = Mat3::identity()};
    std::vector<Vec3f> places;
    for (float x = -0.09f; x < 0.1f; x += 0.02f) {
        for (float y = -0.09f; y < 0.1f; y += 0.02f) places.push_back({x, y, 0.07f});
    }
    FluidSolver solver({}, 0.04, {.particle_volume = 8e-6}, places, {0, nan, 0});
    TaskPool workers(1);
    const FluidOutcome outcome = solver.advance(1.0 / 60, {0, -9.81, 0}, {&obstacle, 1}, workers);
    EXPECT_FALSE(outcome.is_finite);
    EXPECT_EQ(obstacle.impulse, Vec3{});
    EXPECT_EQ(obstacle.angular_impulse, Vec3{});
}

TEST(Fluid, DegenerateLiquidsStayFinite) {
    auto world = make_world();
    add_basin(*world);
    // One particle, all in one place, and a sheet thinner than a particle.
    ASSERT_TRUE(world->create_fluid({.points = {{0.5, 0.5, 0.5}}, .cell_size = 0.05}));
    ASSERT_TRUE(world->create_fluid({.points = std::vector<Vec3>(500, {0.5, 0.2, 0.5}), .cell_size = 0.05}));
    ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0.3, 0}, {1, 0.301, 1}}}, .cell_size = 0.05}));
    for (int i = 0; i < 120; ++i) world->step();
    EXPECT_TRUE(std::isfinite(world->conserved().kinetic_energy));
    for (const FluidHandle fluid : world->fluids()) EXPECT_FALSE(world->fluid_particles(fluid).is_frozen);
}

TEST(Fluid, CalmWaterSleepsAndWakesWhenSomethingFallsIn) {
    auto world = make_world();
    add_basin(*world);
    const FluidHandle water = world->create_fluid({.boxes = {{{0, 0, 0}, {1, 0.5, 1}}}, .cell_size = 0.1}).value();
    for (int i = 0; i < 600 && !world->fluid_particles(water).is_asleep; ++i) world->step();
    EXPECT_TRUE(world->fluid_particles(water).is_asleep);
    const std::uint64_t asleep = world->state_hash();
    for (int i = 0; i < 10; ++i) world->step();
    EXPECT_EQ(world->state_hash(), asleep);
    add_box(*world, {0.1, 0.1, 0.1}, {.position = {0.5, 0.8, 0.5}});
    for (int i = 0; i < 30; ++i) world->step();
    EXPECT_FALSE(world->fluid_particles(water).is_asleep);
}

}  // namespace
}  // namespace embody::physics::fluid
