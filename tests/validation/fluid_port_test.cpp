// SPDX-License-Identifier: MIT
// Sources and drains: what came in less what went out is there, by particles; the rate is the one that was asked for.
#include <algorithm>
#include <limits>

#include "foundation/random.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr Bounds tank{{-0.3, 0, -0.3}, {0.3, 0.5, 0.3}};

std::size_t count_of(const World& world, FluidHandle fluid) { return world.fluid_particles(fluid).positions.size(); }

FluidHandle fill(World& world, double depth, double cell) {
    add_tank(world, tank);
    return world.create_fluid({.boxes = {{tank.lower, {tank.upper.x, depth, tank.upper.z}}}, .cell_size = cell})
        .value();
}

class FluidPorts : public testing::TestWithParam<unsigned> {};

TEST_P(FluidPorts, WhatCameInLessWhatWentOutIsThere) {
    Random random(GetParam() + 1);
    auto world = make_world({});
    const double cell = random.between(0.03, 0.05);
    const FluidHandle water = fill(*world, 0.1, cell);
    const std::size_t before = count_of(*world, water);
    FluidSource tap{.fluid = water,
                    .position = {random.between(-0.15, 0.15), random.between(0.2, 0.4), random.between(-0.15, 0.15)},
                    .direction = {random.between(-0.3, 0.3), -1, random.between(-0.3, 0.3)},
                    .radius = random.between(0.01, 0.05),
                    .rate = random.between(0.5e-3, 3e-3)};
    const FluidPortHandle source = world->create_fluid_port(tap).value();
    const FluidPortHandle drain =
        world->create_fluid_port(FluidDrain{.position = {0, 0, 0}, .radius = random.between(0.6, 1.5) * cell}).value();
    const double seconds = 3;
    for (int i = 0; i < 180; ++i) {
        world->step();
        ASSERT_EQ(count_of(*world, water) + world->passed_particles(drain), before + world->passed_particles(source));
    }
    const double volume = world->fluid_particles(water).particle_volume;
    EXPECT_NEAR(volume * static_cast<double>(world->passed_particles(source)), tap.rate * seconds, volume);
    EXPECT_GT(world->passed_particles(drain), 0u);
    RecordProperty("poured", std::to_string(world->passed_particles(source)));
    RecordProperty("drained", std::to_string(world->passed_particles(drain)));
}

TEST_P(FluidPorts, AJetHasTheRateAndTheSpeedAskedFor) {
    Random random(GetParam() + 101);
    auto world = make_world({.gravity = {0, 0, 0}});
    const FluidHandle water =
        world->create_fluid({.boxes = {{{1, 1, 1}, {1.04, 1.04, 1.04}}}, .cell_size = 0.02}).value();
    const Vec3 direction =
        normalized(Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}, Vec3{1, 0, 0});
    const FluidSource tap{.fluid = water,
                          .direction = direction,
                          .radius = random.between(0.02, 0.04),
                          .rate = random.between(2e-3, 4e-3)};
    ASSERT_TRUE(world->create_fluid_port(tap));
    run(*world, 0.5);
    // Through a plane across the jet at 0.1 m and one at 0.2 m: what is between them moves on by the speed.
    const FluidParticles particles = world->fluid_particles(water);
    double between = 0, farthest = 0, widest = 0;
    for (const Vec3f p : particles.positions) {
        const Vec3 place = particles.origin + Vec3(p);
        const double along = dot(place, direction);
        if (length(place) > 1.2) continue;  // the first water
        between += along > 0.1 && along < 0.2 ? particles.particle_volume : 0;
        farthest = std::max(farthest, along);
        widest = std::max(widest, length(place - along * direction));
    }
    const double area = pi * tap.radius * tap.radius, speed = tap.rate / area;
    RecordProperty("area_ratio", std::to_string(between / 0.1 / area));
    RecordProperty("speed_ratio", std::to_string(farthest / 0.5 / speed));
    EXPECT_NEAR(between / 0.1, area, 0.1 * area);
    EXPECT_NEAR(farthest, 0.5 * speed, 0.05 * speed);
    EXPECT_LT(widest, 1.5 * tap.radius);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FluidPorts, testing::Range(0u, 6u));

TEST(FluidPort, GoesAlongWithItsBodyAndEndsWithIt) {
    auto world = make_world({.gravity = {0, 0, 0}});
    const FluidHandle water = world->create_fluid({.boxes = {{{1, 1, 1}, {1.1, 1.1, 1.1}}}, .cell_size = 0.05}).value();
    const BodyHandle hose =
        add_box(*world, {0.01, 0.01, 0.01}, {.kind = BodyKind::kinematic_body, .linear_velocity = {0.5, 0, 0}});
    const FluidPortHandle tap =
        world
            ->create_fluid_port(
                FluidSource{.fluid = water, .body = hose, .position = {0, -0.02, 0}, .rate = 1e-3, .speed = 1})
            .value();
    run(*world, 0.5);
    // The hose moves by 0.25 m along X, and so does what comes out of it.
    const FluidParticles particles = world->fluid_particles(water);
    for (const Vec3f p : particles.positions) {
        const Vec3 place = particles.origin + Vec3(p);
        if (place.y < 0) EXPECT_NEAR(place.x, 0.25, 0.03);
    }
    const std::uint64_t passed = world->passed_particles(tap);
    EXPECT_GT(passed, 0u);
    ASSERT_TRUE(world->destroy_body(hose));
    run(*world, 0.5);
    EXPECT_EQ(world->passed_particles(tap), passed);
}

TEST(FluidPort, ShutItPassesNothingAndWaitsWhereTheFluidIsFull) {
    auto world = make_world({});
    const FluidHandle water = fill(*world, 0.1, 0.05);
    const std::size_t before = count_of(*world, water);
    FluidSource tap{.fluid = water, .position = {0, 0.3, 0}, .rate = 2e-3, .is_open = false};
    const FluidPortHandle source = world->create_fluid_port(tap).value();
    run(*world, 0.5);
    EXPECT_EQ(count_of(*world, water), before);
    tap.is_open = true;
    tap.max_particles = before + 20;
    ASSERT_TRUE(world->set_fluid_port(source, tap));
    EXPECT_FALSE(world->is_waiting(source));
    std::uint32_t limits = 0;
    for (int i = 0; i < 60; ++i) limits |= world->step().limits;
    EXPECT_EQ(count_of(*world, water), before + 20);
    EXPECT_NE(limits & static_cast<std::uint32_t>(StepLimit::fluid_source_waits), 0u);
    EXPECT_TRUE(world->is_waiting(source));
    ASSERT_TRUE(world->destroy_fluid_port(source));
    EXPECT_FALSE(world->is_waiting(source));
    EXPECT_FALSE(world->destroy_fluid_port(source));
    EXPECT_EQ(world->fluid_port(source), nullptr);
}

// A fluid without a drop has its places and its volume of a particle; what comes is of the source's matter.
TEST_P(FluidPorts, FillAFluidThatStartsEmptyWithTheirOwnMatter) {
    Random random(GetParam() + 201);
    auto world = make_world({});
    add_tank(*world, tank);
    const Vec3 far{random.between(-200, 200), 0, random.between(-200, 200)};
    const FluidDefinition nothing{.boxes = {{far + tank.lower, far + Vec3{tank.upper.x, 0.2, tank.upper.z}}},
                                  .density = 900,
                                  .cell_size = 0.05,
                                  .starts_empty = true};
    const FluidHandle fluid = world->create_fluid(nothing).value();
    EXPECT_EQ(count_of(*world, fluid), 0u);
    run(*world, 0.1);
    const FluidIds ids = world->make_room(fluid, {}, 300).value();
    EXPECT_EQ(ids.last - ids.first, 300u);
    const LiquidMatter honey{.density = 1400, .viscosity = 5};
    const FluidPortHandle tap = world
                                    ->create_fluid_port(FluidSource{.fluid = fluid,
                                                                    .position = far + Vec3{0, 0.3, 0},
                                                                    .radius = 0.03,
                                                                    .rate = random.between(1e-3, 3e-3),
                                                                    .matter = honey,
                                                                    .ids = ids})
                                    .value();
    std::uint32_t limits = 0;
    for (int i = 0; i < 180; ++i) {
        limits |= world->step().limits;
        ASSERT_EQ(count_of(*world, fluid), world->passed_particles(tap));
    }
    const FluidParticles particles = world->fluid_particles(fluid);
    for (const std::uint32_t id : particles.ids) EXPECT_TRUE(ids.contains(id));
    EXPECT_EQ(world->fluid(fluid)->density, honey.density);
    EXPECT_LT(length(particles.origin - far), 2);
    // The ids that were kept are used up.
    EXPECT_EQ(particles.ids.size() == 300, (limits & static_cast<std::uint32_t>(StepLimit::fluid_source_waits)) != 0);
}

// Several sources share the ids that are kept for them, and no particle has another's.
TEST_P(FluidPorts, ShareKeptIdsAndLeaveTheOthersTheirs) {
    Random random(GetParam() + 301);
    auto world = make_world({});
    const FluidHandle water = fill(*world, 0.1, 0.05);
    const auto before = static_cast<std::uint32_t>(count_of(*world, water));
    const FluidIds half = world->make_room(water, {before / 2, before}, 5000).value();
    EXPECT_EQ(half.last - half.first, before - before / 2 + 5000);
    const FluidIds room{half.last - 5000, half.last};
    std::vector<FluidPortHandle> taps;
    for (int i = 0; i < 3; ++i)
        taps.push_back(world
                           ->create_fluid_port(FluidSource{.fluid = water,
                                                           .position = {0.1 * i - 0.1, 0.3, 0},
                                                           .radius = 0.02,
                                                           .rate = random.between(5e-4, 2e-3),
                                                           .ids = room})
                           .value());
    run(*world, 1);
    std::uint64_t poured = 0;
    for (const FluidPortHandle tap : taps) poured += world->passed_particles(tap);
    const FluidParticles particles = world->fluid_particles(water);
    std::vector<std::uint32_t> ids(particles.ids.begin(), particles.ids.end());
    std::ranges::sort(ids);
    EXPECT_EQ(std::ranges::adjacent_find(ids), ids.end());
    EXPECT_EQ(ids.size(), before + poured);
    const auto in_half = std::ranges::count_if(ids, [&](std::uint32_t id) { return half.contains(id); });
    EXPECT_EQ(static_cast<std::uint64_t>(in_half), before - before / 2 + poured);
}

TEST(FluidPort, DropsAreAddedExactlyAndNonsenseIsRefused) {
    auto world = make_world({});
    const FluidHandle water = fill(*world, 0.1, 0.05);
    const std::size_t before = count_of(*world, water);
    // In the floor of the tank, where add_to_fluid leaves them out.
    const std::vector<FluidDrop> drops{{{0, -0.01, 0}, {1, 0, 0}}, {{0, 0.2, 0}, {}}};
    const FluidIds ids = world->add_drops(water, drops).value();
    EXPECT_EQ(ids.last - ids.first, 2u);
    EXPECT_EQ(count_of(*world, water), before + 2);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = world->add_drops(water, std::vector<FluidDrop>{{{0, nan, 0}, {}}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "drops[0].position.y");
    EXPECT_FALSE(world->make_room(water, {}, ~std::uint32_t{0}));
    EXPECT_FALSE(world->make_room({}, {}, 1));
    const auto unkept = world->create_fluid_port(FluidSource{.fluid = water, .ids = {0, ~std::uint32_t{0}}});
    ASSERT_FALSE(unkept);
    EXPECT_EQ(unkept.error().where, "ids");
    const auto mercury = world->create_fluid_port(FluidSource{.fluid = water, .matter = LiquidMatter{.density = nan}});
    ASSERT_FALSE(mercury);
    EXPECT_EQ(mercury.error().where, "matter.density");
}

TEST(FluidPort, WakesWaterThatSleeps) {
    auto world = make_world({});
    const FluidHandle water = fill(*world, 0.1, 0.05);
    for (int i = 0; i < 1800 && !world->fluid_particles(water).is_asleep; ++i) world->step();
    ASSERT_TRUE(world->fluid_particles(water).is_asleep);
    const FluidPortHandle drain = world->create_fluid_port(FluidDrain{.radius = 0.06}).value();
    world->step();
    EXPECT_FALSE(world->fluid_particles(water).is_asleep);
    EXPECT_GT(world->passed_particles(drain), 0u);
}

TEST(FluidPort, HasEqualBitsForAnyNumberOfWorkers) {
    std::vector<Vec3f> first;
    for (const int workers : {1, 3}) {
        auto world = make_world({.workers = workers});
        const FluidHandle water = fill(*world, 0.15, 0.03);
        ASSERT_TRUE(world->create_fluid_port(
            FluidSource{.fluid = water, .position = {0.05, 0.3, 0}, .radius = 0.03, .rate = 2e-3}));
        ASSERT_TRUE(world->create_fluid_port(FluidDrain{.radius = 0.04}));
        run(*world, 0.3);
        const auto positions = world->fluid_particles(water).positions;
        if (first.empty()) first.assign(positions.begin(), positions.end());
        ASSERT_EQ(first.size(), positions.size());
        for (std::size_t i = 0; i < first.size(); ++i) ASSERT_EQ(first[i], positions[i]);
    }
}

TEST(FluidPort, WhatMakesNoSenseIsRefusedByField) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    auto world = make_world({});
    const FluidHandle water = fill(*world, 0.1, 0.05);
    const auto field = [&](auto change) {
        FluidSource source{.fluid = water};
        change(source);
        const auto made = world->create_fluid_port(source);
        return made ? std::string("accepted") : made.error().where;
    };
    EXPECT_EQ(field([](FluidSource&) {}), "accepted");
    EXPECT_EQ(field([](FluidSource& s) { s.fluid = {}; }), "fluid");
    EXPECT_EQ(field([](FluidSource& s) { s.fluid.generation += 7; }), "fluid");
    EXPECT_EQ(field([](FluidSource& s) { s.body = {3, 9}; }), "body");
    EXPECT_EQ(field([](FluidSource& s) { s.position.y = nan; }), "position.y");
    EXPECT_EQ(field([](FluidSource& s) { s.direction = {}; }), "direction");
    EXPECT_EQ(field([](FluidSource& s) { s.direction.x = nan; }), "direction.x");
    EXPECT_EQ(field([](FluidSource& s) { s.radius = -1; }), "radius");
    EXPECT_EQ(field([](FluidSource& s) { s.radius = 0; }), "speed");
    EXPECT_EQ(field([](FluidSource& s) { s.rate = nan; }), "rate");
    EXPECT_EQ(field([](FluidSource& s) { s.radius = 1e-4; }), "radius") << "3,183 m/s";
    EXPECT_EQ(field([](FluidSource& s) { s.radius = 1e-200; }), "radius");
    EXPECT_EQ(field([](FluidSource& s) { s.direction = {0, 1e-200, 0}; }), "direction");
    EXPECT_EQ(field([](FluidSource& s) { s.max_particles = max_fluid_particles + 1; }), "max_particles");
    EXPECT_EQ(field([](FluidSource& s) { s.speed = 1e9; }), "speed");
    const auto drain = world->create_fluid_port(FluidDrain{.radius = nan});
    ASSERT_FALSE(drain);
    EXPECT_EQ(drain.error().where, "radius");
}

}  // namespace
}  // namespace embody::physics
