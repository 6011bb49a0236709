// SPDX-License-Identifier: MIT
// Closed sheets with gas inside, over random families: Laplace's law, the force of a pressed ball, momenta, bounces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double air_pressure = 101'325;  // Pa

double of_scale(Random& random, double low, double high) {
    return std::exp(random.between(std::log(low), std::log(high)));
}

// A sphere of a weave that the pressure stretches by about `strain`.
struct Ball {
    double radius = 0, stiffness = 0, pressure = 0;  // m, N/m, Pa
    DeformableDefinition definition;

    Ball(Random& random, double strain, double pressure, double edge)
        : radius(random.between(0.1, 0.3)), stiffness(pressure * radius / (2 * strain)), pressure(pressure) {
        definition = cloth_sphere(radius, std::clamp(edge, radius / 9, radius / 2.5),
                                  {.area_density = random.between(0.1, 0.6),
                                   .stretch_stiffness = stiffness,
                                   .shear_stiffness = stiffness / 2.5,
                                   .inflation = pressure});
    }
};

double volume_of(std::span<const Vec3> nodes, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    double volume = 0;
    for (const auto& t : triangles) volume += dot(nodes[t[0]], cross(nodes[t[1]], nodes[t[2]])) / 6;
    return volume;
}

double growth_of(const World& world, DeformableHandle ball) {
    const DeformableDefinition& definition = *world.deformable(ball);
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    return volume_of(world.node_positions(ball), triangles) / volume_of(definition.nodes, triangles);
}

// Boyle's law.
double gauge_of(const World& world, DeformableHandle ball) {
    const double inflation = std::get<Cloth>(world.deformable(ball)->matter).inflation;
    return (air_pressure + inflation) / growth_of(world, ball) - air_pressure;
}

Vec3 spin_of(const World& world, DeformableHandle ball) {
    const Conserved all = world.conserved();
    return all.angular_momentum - cross(world.center_of_mass(ball), all.linear_momentum);
}

// The tension p r/2 of a sphere (Laplace) stretches threads along warp and weft, which have no lateral contraction.
TEST(Inflation, StretchesASphereAsLaplaceSays) {
    Random random(1);
    for (int i = 0; i < 12; ++i) {
        const Ball ball(random, random.between(0.005, 0.08), of_scale(random, 200, 5e4), random.between(0.02, 0.06));
        const auto world = make_world({.gravity = {}});
        const DeformableHandle handle = world->create_deformable(ball.definition).value();
        run(*world, 2);
        const double stretch = std::cbrt(growth_of(*world, handle));
        const double expected = gauge_of(*world, handle) * ball.radius * stretch * stretch / (2 * ball.stiffness);
        EXPECT_NEAR(stretch - 1, expected, 0.05 * expected) << i;
        EXPECT_TRUE(world->is_asleep(handle)) << i;
    }
}

TEST(Inflation, OfALivingSheetIsSetLikeAllElse) {
    Random random(2);
    const Ball ball(random, 0.03, 5000, 0.04);
    const auto world = make_world({.gravity = {}});
    DeformableDefinition slack = ball.definition;
    std::get<Cloth>(slack.matter).inflation = 0;
    const DeformableHandle handle = world->create_deformable(slack).value();
    run(*world, 1);
    EXPECT_NEAR(growth_of(*world, handle), 1, 1e-3);
    ASSERT_TRUE(world->set_deformable(handle, ball.definition).ok());
    run(*world, 1);
    EXPECT_GT(growth_of(*world, handle), 1.05);
    ASSERT_TRUE(world->set_deformable(handle, slack).ok());
    run(*world, 1);
    EXPECT_NEAR(growth_of(*world, handle), 1, 0.01);
}

// Under a plate that cannot tilt: weight = gauge pressure × contact area, above and below.
TEST(Inflation, ABallBetweenPlatesBearsItsPressureTimesItsContactArea) {
    Random random(3);
    for (int i = 0; i < 6; ++i) {
        const double pressure = of_scale(random, 1e3, 2e4), share = random.between(0.3, 0.6);
        const Ball ball(random, random.between(0.02, 0.05), pressure, 0.02);
        const auto world = make_world({});
        add_plane(*world, friction(0.5));
        DeformableDefinition definition = ball.definition;
        definition.pose.position = {0, ball.radius + 0.002, 0};
        const DeformableHandle handle = world->create_deformable(definition).value();
        const double half = 0.02, mass = pressure * share * pi * ball.radius * ball.radius / gravity;
        const BodyHandle plate =
            world
                ->create_body(
                    {.shape = world->create_shape(BoxShape{{1.5 * ball.radius, half, 1.5 * ball.radius}}).value(),
                     .position = {0, 2.1 * ball.radius + half, 0},
                     .mass = {.mass = mass, .inertia = Mat3::diagonal({1e6, 1e6, 1e6})}})
                .value();
        run(*world, 8);
        EXPECT_LT(length(world->linear_velocity(plate)), 0.01) << i;
        const double under = world->pose(plate).position.y - half;
        const std::span<const Vec3> nodes = world->node_positions(handle);
        double above = 0, below = 0;  // m²
        for (const auto& t : std::get<Cloth>(definition.matter).triangles) {
            const double area = length(cross(nodes[t[1]] - nodes[t[0]], nodes[t[2]] - nodes[t[0]])) / 2;
            for (const std::uint32_t node : t) {
                if (nodes[node].y > under - 2e-3) above += area / 3;
                if (nodes[node].y < 2e-3) below += area / 3;
            }
        }
        const double gauge = gauge_of(*world, handle), weight = mass * gravity;
        EXPECT_NEAR(gauge * above, weight, 0.1 * weight) << i;
        EXPECT_NEAR(gauge * below, weight, 0.1 * weight) << i;
    }
}

TEST(Inflation, KeepsMomentumAndSpinInFlight) {
    Random random(4);
    for (int i = 0; i < 12; ++i) {
        Ball ball(random, random.between(0.01, 0.08), of_scale(random, 200, 5e4), random.between(0.03, 0.06));
        const auto any = [&](double most) {
            return Vec3{random.between(-most, most), random.between(-most, most), random.between(-most, most)};
        };
        ball.definition.linear_velocity = any(5);
        ball.definition.angular_velocity = any(10);
        const auto world = make_world({.gravity = {}, .air_density = 0});
        const DeformableHandle handle = world->create_deformable(ball.definition).value();
        const Vec3 momentum = world->conserved().linear_momentum, spin = spin_of(*world, handle);
        run(*world, 2);
        EXPECT_LT(length(world->conserved().linear_momentum - momentum), 1e-6 * length(momentum)) << i;
        EXPECT_LT(length(spin_of(*world, handle) - spin), 1e-5 * length(spin)) << i;
    }
}

// A ball in the air above a floor, a wall's rim or a tilted block.
struct Drop {
    std::unique_ptr<World> world;
    DeformableHandle handle;
    double height = 0;  // m, of its fall

    explicit Drop(std::uint64_t seed, WorldSettings settings = {}) {
        Random random(seed);
        settings.air_density = 0;
        world = make_world(settings);
        add_plane(*world, friction(0.5));
        Ball ball(random, random.between(0.01, 0.1), of_scale(random, 500, 5e4), random.between(0.02, 0.06));
        double top = 0;
        const auto add = [&](Vec3 half, Vec3 position, Quat rotation) {
            EXPECT_TRUE(world
                            ->create_body({.kind = BodyKind::static_body,
                                           .shape = world->create_shape(BoxShape{half}).value(),
                                           .position = position,
                                           .rotation = rotation})
                            .ok());
            top = position.y + half.y;
        };
        if (seed % 3 == 1)
            add({0.05, 0.2, 0.3}, {random.between(-0.1, 0.1), 0.2, 0},
                from_axis_angle({0, 1, 0}, random.between(0, pi)));
        if (seed % 3 == 2)
            add({0.2, 0.2, 0.2}, {random.between(-0.2, 0.2), 0.15, random.between(-0.2, 0.2)},
                from_axis_angle(normalized(Vec3{random.between(-1, 1), 0.1, random.between(-1, 1)}),
                                random.between(0, pi)));
        height = random.between(0.3, 2);
        ball.definition.pose.position = {0, top + 1.1 * ball.radius + height, 0};
        ball.definition.linear_velocity = {random.between(-2, 2), 0, random.between(-2, 2)};
        ball.definition.angular_velocity = {random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)};
        handle = world->create_deformable(ball.definition).value();
    }
};

TEST(Inflation, BallsBounce) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Drop drop(seed);
        World& world = *drop.world;
        run(world, 0.1);  // blown up
        const double scale = world.conserved().kinetic_energy + world.mass(drop.handle) * gravity * drop.height;
        double lowest = energy(world), gain = 0, fastest_down = 0, fastest_up = 0;
        for (int i = 0; i < 300; ++i) {
            world.step();
            const double now = energy(world);
            ASSERT_TRUE(std::isfinite(now)) << seed << " " << i;
            gain = std::max(gain, now - lowest);
            lowest = std::min(lowest, now);
            const double up = world.conserved().linear_momentum.y / world.mass(drop.handle);
            fastest_down = std::max(fastest_down, -up);
            fastest_up = std::max(fastest_up, up);
        }
        EXPECT_LT(gain, 0.01 * scale) << seed;
        if (seed % 3 == 0) {
            EXPECT_GT(fastest_up, 0.4 * fastest_down) << seed;
        }
    }
}

TEST(Inflation, SameBitsForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 4}) {
        const auto world = make_world({.workers = workers});
        add_plane(*world, friction(0.5));
        auto ball = cloth_sphere(0.3, 0.025, {.stretch_stiffness = 5000, .inflation = 3000});
        ball.pose.position = {0, 0.6, 0};
        ASSERT_GT(ball.nodes.size(), 1000u);
        ASSERT_TRUE(world->create_deformable(ball).ok());
        auto bed = cloth_box({0.6, 0.15, 0.5}, 0.06, {.inflation = 1000});
        bed.pose.position = {0.1, 0.09, 0};
        ASSERT_TRUE(world->create_deformable(bed).ok());
        run(*world, 0.7);
        hashes.push_back(world->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

// What is kept of a sheet are its places, speeds and folds: its gas is that of its volume at rest.
TEST(Inflation, GoesOnWhereItWasKept) {
    const Drop drop(3);
    World& world = *drop.world;
    run(world, 0.5);
    const Drop again(3);
    ASSERT_TRUE(
        again.world->set_nodes(again.handle, world.node_positions(drop.handle), world.node_velocities(drop.handle))
            .ok());
    ASSERT_TRUE(again.world->set_lasting_deformation(again.handle, world.lasting_deformation(drop.handle)).ok());
    EXPECT_DOUBLE_EQ(growth_of(*again.world, again.handle), growth_of(world, drop.handle));
    EXPECT_NEAR(energy(*again.world), energy(world), 1e-9 * std::fabs(energy(world)));
    const World& kept = *again.world;
    again.world->step();
    EXPECT_NEAR(growth_of(kept, again.handle), growth_of(world, drop.handle), 2e-3);
}

}  // namespace
}  // namespace embody::physics
