// SPDX-License-Identifier: MIT
// Liquids with what bends: soft solids and ropes; sheets: fluid_cloth_test.cpp (docs/physics/coupling.md, "Liquids and
// what bends").
#include "foundation/random.h"
#include "math/kernel_width.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double water_density = 998;  // kg/m³, the fluids' default

SoftSolid foam_of(double density, double youngs_modulus) {
    return {.density = density, .youngs_modulus = youngs_modulus, .poisson_ratio = 0.2, .rayleigh_damping = 0.01};
}

Vec3 mean_velocity_of(const World& world, DeformableHandle handle) {
    Vec3 sum;
    const auto masses = world.node_masses(handle);
    const auto velocities = world.node_velocities(handle);
    for (std::size_t i = 0; i < velocities.size(); ++i) sum += masses[i] * velocities[i];
    return sum / world.mass(handle);
}

// Of the particles, m/s.
Vec3 mean_velocity_of(const World& world, FluidHandle fluid) {
    const FluidParticles particles = world.fluid_particles(fluid);
    Vec3 sum;
    for (const Vec3f v : particles.velocities) sum += Vec3(v);
    return sum / static_cast<double>(particles.velocities.size());
}

// Archimedes: a floating block displaces its weight, so the draft is its density over the water's of its height.
TEST(FluidSoftSolid, FloatsAtItsDraft) {
    Random random(11);
    for (int round = 0; round < 3; ++round) {
        SCOPED_TRACE(round);
        const double density = round == 0 ? 200 : random.between(150, 700), cell = 0.04, side = 0.6, depth = 0.32;
        const Vec3 size{random.between(0.22, 0.3), random.between(0.14, 0.2), random.between(0.22, 0.3)};
        auto world = make_world({});
        add_tank(*world, {{0, 0, 0}, {side, 0.8, side}});
        ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0, 0}, {side, depth, side}}}, .cell_size = cell}));
        DeformableDefinition block = tetrahedral_brick(size, {6, 4, 6}, foam_of(density, random.between(1e5, 1e6)));
        block.pose.position = Vec3{side / 2 - size.x / 2, depth + 0.02, side / 2 - size.z / 2};
        block.contact_radius = 0.005;
        const DeformableHandle handle = world->create_deformable(block).value();
        run(*world, 6);
        double draft = 0;
        constexpr int samples = 120;
        const double level = depth + world->mass(handle) / water_density / (side * side);
        for (int i = 0; i < samples; ++i) {
            world->step();
            draft += (level - (world->center_of_mass(handle).y - size.y / 2)) / samples;
        }
        const double ratio = draft / (size.y * density / water_density);
        RecordProperty("draft_" + std::to_string(round), std::to_string(ratio));
        EXPECT_NEAR(ratio, 1, 0.1) << density;
    }
}

// Weight less buoyancy against ρ/2 d C_d U² a length, C_d of C. Wieselsberger (1921): 1.0 at Re from 1e3 to 1e4.
TEST(FluidRope, SinksBroadsideAtItsTerminalSpeed) {
    Random random(5);
    for (int round = 0; round < 3; ++round) {
        SCOPED_TRACE(round);
        const double cell = 0.04, side = 0.56, depth = 1.4, diameter = random.between(0.006, 0.012);
        const double density = random.between(1200, 3000), area = pi / 4 * diameter * diameter;
        auto world = make_world({});
        add_tank(*world, {{0, 0, 0}, {side, depth + 0.3, side}});
        ASSERT_TRUE(world->create_fluid(
            {.boxes = {{{0, 0, 0}, {side, depth, side}}}, .cell_size = cell, .allow_sleep = false}));
        run(*world, 0.5);
        const Rope rope{.diameter = diameter, .linear_density = density * area};
        DeformableDefinition line = rope_between({0.18, 1.2, side / 2}, {0.38, 1.2, side / 2}, 0.02, rope);
        line.contact_radius = diameter / 2;
        const DeformableHandle handle = world->create_deformable(line).value();
        double speed = 0;
        for (int i = 0; i < 300 && world->center_of_mass(handle).y > 0.5; ++i) {
            world->step();
            speed = -mean_velocity_of(*world, handle).y;
        }
        const double expected =
            std::sqrt((density - water_density) * area * gravity / (water_density / 2 * diameter * 1.0));
        RecordProperty("speed_" + std::to_string(round), std::to_string(speed / expected));
        EXPECT_NEAR(speed / expected, 1, 0.15);
    }
}

TEST(FluidRope, LighterThanWaterItFloats) {
    const double cell = 0.03, side = 0.48, depth = 0.3;
    auto world = make_world({});
    add_tank(*world, {{0, 0, 0}, {side, 0.6, side}});
    ASSERT_TRUE(world->create_fluid({.boxes = {{{0, 0, 0}, {side, depth, side}}}, .cell_size = cell}));
    const double diameter = 0.016, area = pi / 4 * diameter * diameter;
    DeformableDefinition line = rope_between({0.1, 0.1, side / 2}, {0.38, 0.1, side / 2}, 0.02,
                                             {.diameter = diameter, .linear_density = 500 * area});
    line.contact_radius = diameter / 2;
    const DeformableHandle handle = world->create_deformable(line).value();
    run(*world, 4);
    EXPECT_NEAR(world->center_of_mass(handle).y, depth, cell);
    EXPECT_LT(length(mean_velocity_of(*world, handle)), 0.05);
}

// A block of liquid flies past what is thrown into it: nothing else acts. With one substep a step the way of the centre
// of mass tells the momentum that the nodes carry. Drops that leave the block together with a solid are not counted
// with it.
TEST(FluidDeformables, KeepTheCommonMomentum) {
    Random random(8);
    for (int trial = 0; trial < 9; ++trial) {
        const bool is_solid = trial % 3 == 1, is_sheet = trial % 3 == 2;
        SCOPED_TRACE(trial);
        auto world = make_world({.gravity = {0, 0, 0}, .air_density = 0, .deformable_substeps = 1});
        const FluidHandle water =
            world->create_fluid({.boxes = {{{0, 0, 0}, {0.3, 0.3, 0.3}}}, .cell_size = 0.03}).value();
        DeformableDefinition thrown = is_solid ? tetrahedral_brick({0.1, 0.1, 0.1}, {3, 3, 3}, foam_of(300, 1e5))
                                               : rope_between({-0.1, 0.14, 0.1}, {0.1, 0.16, 0.2}, 0.02);
        if (is_sheet) thrown = cloth_rectangle(0.15, 0.15, 0.03, {.area_density = random.between(0.1, 1)});
        if (is_solid || is_sheet) thrown.pose.position = {0.02, 0.1, 0.1};
        thrown.linear_velocity = {random.between(1, 3), random.between(-1, 1), random.between(-1, 1)};
        const DeformableHandle handle = world->create_deformable(thrown).value();
        const double mass = world->mass(handle), liquid = volume_of(*world, water) * water_density;
        const Vec3 all = mass * thrown.linear_velocity;
        for (int i = 0; i < 15; ++i) {
            const Vec3 before = world->center_of_mass(handle);
            world->step();
            const Vec3 own = (world->center_of_mass(handle) - before) * (mass / world->settings().time_step);
            if (i < 14) continue;
            const Vec3 error = own + liquid * mean_velocity_of(*world, water) - all;
            RecordProperty("error_" + std::to_string(trial), std::to_string(length(error) / length(all)));
            const double kept = is_solid ? 5e-3 : 1e-5;
            EXPECT_LT(length(error), kept * length(all));
            EXPECT_LT(length(own), 0.8 * length(all));
        }
    }
}

// A rope that hangs into a stream lies back by the angle at which the drag across it, ρ/2 d C_d (U cos α)² a length,
// holds what is left of its weight, across it too: w sin α. The stream: a block of liquid that flies past.
TEST(FluidRope, HeldInAStreamTrailsDownstream) {
    constexpr double speed = 1.5, diameter = 0.01;
    auto world = make_world({.gravity = {0, 0, 0}});
    const FluidHandle water = world
                                  ->create_fluid({.boxes = {{{-1.6, -0.15, -0.15}, {0.2, 0.15, 0.15}}},
                                                  .velocity = {speed, 0, 0},
                                                  .cell_size = 0.03,
                                                  .allow_sleep = false})
                                  .value();
    DeformableDefinition line =
        rope_between({0, 0.1, 0}, {0, -0.1, 0}, 0.02, {.diameter = diameter, .linear_density = 0.08});
    line.contact_radius = diameter / 2;
    DeformableDefinition held = line;
    for (std::uint32_t i = 0; i < held.nodes.size(); ++i) held.pinned.push_back(i);
    ASSERT_TRUE(world->create_deformable(held));
    run(*world, 0.1);
    const double before = mean_velocity_of(*world, water).x, liquid = volume_of(*world, water) * water_density;
    run(*world, 0.4);
    const double force = liquid * (before - mean_velocity_of(*world, water).x) / 0.4;
    const double expected = water_density / 2 * diameter * 0.2 * speed * speed;  // C_d = 1 at Re = 15,000
    RecordProperty("drag", std::to_string(force / expected));
    EXPECT_NEAR(force / expected, 1, 0.25);
    ASSERT_TRUE(world->destroy_deformable(world->deformables().front()));
    line.pinned = {0};
    const DeformableHandle loose = world->create_deformable(line).value();
    run(*world, 0.3);
    EXPECT_GT(world->node_positions(loose).back().x, 0.1);
    EXPECT_GT(world->center_of_mass(loose).x, 0.05);
}

// What lies on the ground wakes again where the water moves.
TEST(FluidDeformables, AtRestInWaterAtRestTheySleep) {
    auto world = make_world({});
    constexpr double side = 0.4, depth = 0.2;
    add_tank(*world, {{0, 0, 0}, {side, 0.5, side}});
    const FluidHandle water =
        world->create_fluid({.boxes = {{{0, 0, 0}, {side, depth, side}}}, .cell_size = 0.04}).value();
    DeformableDefinition line = rope_between({0.1, 0.02, 0.1}, {0.3, 0.02, 0.1}, 0.02, {.linear_density = 0.2});
    line.contact_radius = 0.005;
    const DeformableHandle rope = world->create_deformable(line).value();
    DeformableDefinition sheet = cloth_rectangle(0.15, 0.15, 0.03, {.area_density = 0.5});
    sheet.pose.position = {0.2, 0.006, 0.25};
    sheet.contact_radius = 0.005;
    const DeformableHandle cloth = world->create_deformable(sheet).value();
    const auto all_sleep = [&] {
        return world->is_asleep(rope) && world->is_asleep(cloth) && world->fluid_particles(water).is_asleep;
    };
    for (int i = 0; i < 20 && !all_sleep(); ++i) run(*world, 0.5);
    EXPECT_TRUE(all_sleep());
    run(*world, 0.5);
    EXPECT_TRUE(all_sleep());
    ASSERT_TRUE(world->wake(rope));
    world->step();
    EXPECT_FALSE(world->fluid_particles(water).is_asleep);
}

TEST(FluidDeformables, HaveTheSameBitsForAnyNumberOfWorkersAndLanes) {
    std::vector<std::unique_ptr<World>> worlds;
    for (const auto& [workers, lanes] : {std::pair{1, 4}, {2, 8}, {4, 16}}) {
        if (!has_lanes(lanes)) continue;  // of this processor
        worlds.push_back(make_world({.workers = workers, .lanes = lanes}));
        World& world = *worlds.back();
        add_tank(world, {{0, 0, 0}, {0.4, 0.6, 0.4}});
        ASSERT_TRUE(world.create_fluid({.boxes = {{{0, 0, 0}, {0.4, 0.2, 0.4}}}, .cell_size = 0.025}));
        ASSERT_TRUE(world.create_deformable(rope_between({0.1, 0.25, 0.1}, {0.3, 0.3, 0.1}, 0.02)));
        DeformableDefinition block = tetrahedral_brick({0.1, 0.1, 0.1}, {3, 3, 3}, foam_of(300, 1e5));
        block.pose.position = {0.05, 0.25, 0.2};
        ASSERT_TRUE(world.create_deformable(block));
        DeformableDefinition sheet = cloth_rectangle(0.15, 0.15, 0.02);
        sheet.pose.position = {0.28, 0.22, 0.28};
        ASSERT_TRUE(world.create_deformable(sheet));
    }
    for (int i = 0; i < 60; ++i) {
        for (const auto& world : worlds) {
            world->step();
            ASSERT_EQ(worlds.front()->state_hash(), world->state_hash()) << "step " << i;
        }
    }
}

}  // namespace
}  // namespace embody::physics
