// SPDX-License-Identifier: MIT
// Closed sheets with gas inside (docs/physics/cloth.md, "Gas inside").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// 0.5 to 50 kPa, edges of 2 to 6 cm; weaves that would stretch by less than `strain` if the pressure stayed.
DeformableDefinition random_ball(Random& random, double strain) {
    const double radius = random.between(0.08, 0.35), edge = std::max(random.between(0.02, 0.06), radius / 7);
    const double pressure = std::exp(random.between(std::log(500), std::log(5e4)));
    const double stiffness = pressure * radius / 2 / random.between(strain / 4, strain);
    return cloth_ball(radius, edge,
                      {.area_density = random.between(0.1, 0.6),
                       .stretch_stiffness = stiffness,
                       .shear_stiffness = random.between(0.2, 0.6) * stiffness,
                       .bend_stiffness = 1e-8 * stiffness,
                       .rayleigh_damping = random.between(0, 0.003),
                       .internal_pressure = pressure});
}

double mean_radius(const World& world, DeformableHandle ball) {
    const Vec3 center = world.center_of_mass(ball);
    const std::span<const Vec3> nodes = world.node_positions(ball);
    double sum = 0;
    for (const Vec3 node : nodes) sum += length(node - center);
    return sum / static_cast<double>(nodes.size());
}

TEST(SheetGas, ABallStretchesByItsPressure) {
    // ε = p r / 2Y (1 - ν), and warp and weft do not act on each other: ν = 0.
    Random random(11);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}});
        const DeformableDefinition definition = random_ball(random, 0.03);
        const Cloth& cloth = std::get<Cloth>(definition.matter);
        const DeformableHandle ball = world->create_deformable(definition).value();
        const double radius = mean_radius(*world, ball), rest = world->gas_inside(ball)->volume;
        EXPECT_NEAR(world->gas_inside(ball)->pressure, cloth.internal_pressure, 1e-6 * cloth.internal_pressure);
        run(*world, 3);
        const auto [volume, pressure] = world->gas_inside(ball).value();
        EXPECT_NEAR((pressure + 101325) * volume, (cloth.internal_pressure + 101325) * rest, 1e-6 * 101325 * volume);
        double area = 0;
        const std::span<const Vec3> nodes = world->node_positions(ball);
        for (const auto& [a, b, c] : cloth.triangles)
            area += length(cross(nodes[b] - nodes[a], nodes[c] - nodes[a])) / 2;
        const double now = 3 * volume / area;  // within the corners
        EXPECT_NEAR((mean_radius(*world, ball) / radius - 1) / (pressure * now / (2 * cloth.stretch_stiffness)), 1,
                    0.05)
            << i;
        EXPECT_TRUE(world->is_asleep(ball)) << i;
    }
}

// Threads that are stretched in the form of the nodes as gas asks: Y (s - 1)/s = p r/2 holds the ball as it is.
TEST(SheetGas, APrestretchedBallKeepsItsForm) {
    Random random(12);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}});
        DeformableDefinition definition = random_ball(random, 0.03);
        Cloth& cloth = std::get<Cloth>(definition.matter);
        const double strain = random.between(0.01, 0.4), radius = length(definition.nodes[0]);
        cloth.stretch_stiffness = cloth.internal_pressure * radius / 2 / strain;
        cloth.shear_stiffness = 0.4 * cloth.stretch_stiffness;
        cloth.prestretch = 1 / (1 - strain);
        const DeformableHandle ball = world->create_deformable(definition).value();
        run(*world, 2);
        EXPECT_NEAR(mean_radius(*world, ball), radius, 0.01 * radius) << i << " strain " << strain;
        EXPECT_NEAR(world->gas_inside(ball)->pressure, cloth.internal_pressure, 0.1 * cloth.internal_pressure)
            << i << " strain " << strain;
    }
}

TEST(SheetGas, InFreeFlightMomentumAndSpinStay) {
    Random random(13);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        DeformableDefinition definition = random_ball(random, 0.03);
        definition.linear_velocity = {random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)};
        definition.angular_velocity = {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
        const DeformableHandle ball = world->create_deformable(definition).value();
        const Conserved start = world->conserved();
        double least = energy(*world);
        for (int step = 0; step < 60; ++step) {
            world->step();
            // Of the motion: the gas moves the sheet first.
            EXPECT_LT(energy(*world), least + 0.01 * start.kinetic_energy) << i << " " << step;
            least = std::min(least, energy(*world));
        }
        const Conserved end = world->conserved();
        EXPECT_LT(length(end.linear_momentum - start.linear_momentum), 1e-6 * length(start.linear_momentum)) << i;
        EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 1e-6 * length(start.angular_momentum)) << i;
        // As one piece, and round.
        EXPECT_GT(end.kinetic_energy, 0.9 * start.kinetic_energy) << i;
        EXPECT_TRUE(world->gas_inside(ball).has_value());
    }
}

TEST(SheetGas, DroppedBallsBounceAndGainNothing) {
    Random random(14);
    double bounced = 0;
    for (int i = 0; i < 12; ++i) {
        const WorldSettings settings{.air_density = 0};
        const auto world = make_world({.gravity = {}, .air_density = 0});
        DeformableDefinition definition = random_ball(random, 0.03);
        const double radius = length(definition.nodes[0]), drop = random.between(0.3, 1.5);
        definition.pose.position = {0, radius + drop, 0};
        add_plane(*world, friction(0.5));
        if (i % 3 > 0) {  // a wall, or a box on whose edge the ball falls
            const Vec3 half = i % 3 == 1 ? Vec3{0.2, 2, 2} : Vec3{0.2, 0.1, 0.2};
            const Vec3 place = i % 3 == 1 ? Vec3{0.3 + 1.5 * radius, 2, 0} : Vec3{random.between(0.15, 0.25), 0.1, 0};
            const BodyDefinition block{.kind = BodyKind::static_body,
                                       .shape = world->create_shape(BoxShape{half}).value(),
                                       .position = place,
                                       .material = friction(0.5)};
            ASSERT_TRUE(world->create_body(block).ok());
        }
        if (i % 3 == 1) {
            definition.linear_velocity = {random.between(1, 4), 0, 0};
            definition.angular_velocity = {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
        }
        const DeformableHandle ball = world->create_deformable(definition).value();
        run(*world, 0.05);  // blown up
        ASSERT_TRUE(world->set_settings(settings).ok());
        const double scale = world->conserved().kinetic_energy + world->mass(ball) * gravity * drop;
        double least = energy(*world), lowest = 1e9, top = 0;
        for (int step = 0; step < 180; ++step) {
            world->step();
            EXPECT_LT(energy(*world), least + 0.01 * scale) << i << " " << step;
            least = std::min(least, energy(*world));
            const double height = world->center_of_mass(ball).y;
            lowest = std::min(lowest, height);
            if (height < lowest + 1e-9) top = height;
            top = std::max(top, height);
        }
        if (i % 3 == 0) {
            bounced += (top - lowest) / drop / 4;
            EXPECT_GT(top - lowest, 0.05 * drop) << i;
        }
    }
    EXPECT_GT(bounced, 0.12);  // 0.02 in whole steps
}

// Balls of flat triangles that roll slowly or drop by a few centimetres rock from face to face.
TEST(SheetGas, BallsThatRockComeToRest) {
    Random random(21);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world();
        add_plane(*world, friction(0.5));
        const double radius = random.between(0.12, 0.35), pressure = random.between(1000, 5000);
        const double stiffness = random.between(4000, 15000);
        DeformableDefinition definition = cloth_ball(radius, radius / random.between(2.5, 4),
                                                     {.area_density = random.between(0.2, 1),
                                                      .stretch_stiffness = stiffness,
                                                      .shear_stiffness = 0.4 * stiffness,
                                                      .rayleigh_damping = random.between(0.001, 0.003),
                                                      .internal_pressure = pressure,
                                                      .prestretch = 1 / (1 - pressure * radius / 2 / stiffness)});
        definition.pose.position = {0, radius + random.between(0.005, 0.1), 0};
        definition.linear_velocity = {random.between(0, 0.3), 0, 0};
        const DeformableHandle ball = world->create_deformable(definition).value();
        run(*world, 6);  // up to 8 s and more where each of its swings is taken in parts
        EXPECT_TRUE(world->is_asleep(ball)) << i;
    }
}

// A net over a ball is no sheet that holds gas.
TEST(SheetGas, IsRefusedInAnOpenSheetOfAWorld) {
    const auto world = make_world();
    const auto open = world->create_deformable(cloth_disc(0.3, 0.05, {.internal_pressure = 100}));
    ASSERT_FALSE(open.ok());
    EXPECT_EQ(open.error().where, "internal_pressure");
    const auto sheet = world->create_deformable(cloth_disc(0.3, 0.05)).value();
    EXPECT_FALSE(world->gas_inside(sheet).has_value());
}

TEST(SheetGas, IsPumpedUpAndLetOut) {
    const auto world = make_world();
    add_plane(*world, friction(0.5));
    DeformableDefinition definition = cloth_ball(
        0.2, 0.05,
        {.area_density = 0.3, .stretch_stiffness = 6000, .shear_stiffness = 2000, .rayleigh_damping = 0.005});
    definition.pose.position = {0, 0.21, 0};
    const DeformableHandle ball = world->create_deformable(definition).value();
    const auto height = [&] {
        double top = 0;
        for (const Vec3 node : world->node_positions(ball)) top = std::max(top, node.y);
        return top;
    };
    run(*world, 1);
    const double soft = height();
    std::get<Cloth>(definition.matter).internal_pressure = 4000;
    ASSERT_TRUE(world->set_deformable(ball, definition).ok());
    run(*world, 2);
    EXPECT_GT(height(), soft + 0.005);
    const double pressure = world->gas_inside(ball)->pressure;
    EXPECT_GT(pressure, 500);
    std::get<Cloth>(definition.matter).internal_pressure = 0;
    ASSERT_TRUE(world->set_deformable(ball, definition).ok());
    run(*world, 2);
    EXPECT_FALSE(world->gas_inside(ball).has_value());
    EXPECT_LT(height(), soft + 0.002);
}

TEST(SheetGas, StaysFiniteAtTheLargestPressure) {
    for (const double stiffness : {1e-3, 1e9}) {
        const auto world = make_world();
        add_plane(*world, friction(0.5));
        DeformableDefinition definition = cloth_ball(
            0.1, 0.05, {.stretch_stiffness = stiffness, .shear_stiffness = stiffness, .internal_pressure = 1e8});
        definition.pose.position = {0, 0.15, 0};
        const DeformableHandle ball = world->create_deformable(definition).value();
        run(*world, 0.2);
        for (const Vec3 node : world->node_positions(ball)) ASSERT_TRUE(is_finite(node)) << stiffness;
    }
}

// Same bits with any number of workers; and the same from a kept form as from where it was kept.
TEST(SheetGas, IsTheSameForAnyNumberOfWorkersAndWhenTakenUpAgain) {
    std::vector<Vec3> first;
    for (const int workers : {1, 2, 3}) {
        const auto world = make_world({.workers = workers});
        add_plane(*world, friction(0.5));
        DeformableDefinition definition = cloth_ball(
            0.3, 0.03,
            {.area_density = 0.3, .stretch_stiffness = 2e4, .shear_stiffness = 8000, .internal_pressure = 4000});
        definition.pose.position = {0, 0.4, 0};
        definition.angular_velocity = {2, 1, 4};
        ASSERT_GT(definition.nodes.size(), 1000U);  // enough for several workers
        const DeformableHandle ball = world->create_deformable(definition).value();
        run(*world, 0.2);
        const std::span<const Vec3> nodes = world->node_positions(ball);
        if (first.empty()) first.assign(nodes.begin(), nodes.end());
        EXPECT_TRUE(std::ranges::equal(nodes, first)) << workers;
    }
    const auto world = make_world();
    add_plane(*world, friction(0.5));
    DeformableDefinition definition = cloth_ball(0.2, 0.05,
                                                 {.area_density = 0.3,
                                                  .stretch_stiffness = 2e4,
                                                  .shear_stiffness = 8000,
                                                  .rayleigh_damping = 0.003,
                                                  .internal_pressure = 4000});
    definition.pose.position = {0, 0.21, 0};
    const DeformableHandle ball = world->create_deformable(definition).value();
    run(*world, 3);
    const std::vector<Vec3> kept(world->node_positions(ball).begin(), world->node_positions(ball).end());
    const std::vector<Vec3> still(kept.size());
    const auto again = make_world();
    add_plane(*again, friction(0.5));
    const DeformableHandle same = again->create_deformable(definition).value();
    ASSERT_TRUE(again->set_nodes(same, kept, still).ok());
    ASSERT_TRUE(again->set_lasting_deformation(same, world->lasting_deformation(ball)).ok());
    EXPECT_EQ(again->gas_inside(same)->pressure, world->gas_inside(ball)->pressure);
    run(*again, 2);
    const std::span<const Vec3> nodes = again->node_positions(same);
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_LT(length(nodes[i] - kept[i]), 1e-3) << i;
}

}  // namespace
}  // namespace embody::physics
