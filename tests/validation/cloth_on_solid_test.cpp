// SPDX-License-Identifier: MIT
// Sheets and ropes on soft solids.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double g = 9.81;
constexpr Vec3 mattress_size{0.6, 0.15, 0.6};

DeformableDefinition mattress(double youngs_modulus) {
    DeformableDefinition made = tetrahedral_brick(mattress_size, {6, 2, 6});
    SoftSolid& solid = std::get<SoftSolid>(made.matter);
    solid.density = 40;
    solid.youngs_modulus = youngs_modulus;
    solid.poisson_ratio = 0;
    solid.rayleigh_damping = 0.02;
    made.pose.position = {-0.3, 0.001, -0.3};
    return made;
}

DeformableDefinition blanket(double side, double area_density, double height) {
    auto made = cloth_rectangle(side, side, 0.04, {.area_density = area_density, .rayleigh_damping = 0.01});
    made.pose.position = {0, height, 0};
    return made;
}

double mean_top(const World& world, DeformableHandle solid) {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < world.node_positions(solid).size(); ++i) {
        const Vec3 rest = world.deformable(solid)->nodes[i];
        if (rest.y < mattress_size.y) continue;
        // A node at an edge has half of the others' area.
        const auto share = [](double x, double size) { return x > 0.01 && x < size - 0.01 ? 1.0 : 0.5; };
        const double own = share(rest.x, mattress_size.x) * share(rest.z, mattress_size.z);
        sum += own * world.node_positions(solid)[i].y;
        area += own;
    }
    return sum / area;
}

TEST(ClothOnSolid, ABlanketWeighsOnWhatItLiesOn) {
    // Without sideways strain the mattress gives way by p L/E under the blanket's p, as under its own weight by half.
    constexpr double youngs_modulus = 5e3, area_density = 20;
    const auto world = make_world({});
    add_plane(*world, {});
    const DeformableHandle solid = world->create_deformable(mattress(youngs_modulus)).value();
    run(*world, 3);
    const double alone = mean_top(*world, solid);
    const DeformableHandle sheet =
        world->create_deformable(blanket(mattress_size.x, area_density, mattress_size.y + 0.02)).value();
    run(*world, 6);
    const double way = area_density * g / youngs_modulus * mattress_size.y;
    EXPECT_NEAR(alone - mean_top(*world, solid), way, 0.15 * way);
    EXPECT_TRUE(world->is_asleep(sheet));
    EXPECT_TRUE(world->is_asleep(solid));
}

TEST(ClothOnSolid, ABlanketFallsOverAMattressAndStaysOnIt) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    const DeformableHandle solid = world->create_deformable(mattress(2e4)).value();
    const DeformableHandle sheet = world->create_deformable(blanket(1.0, 0.4, 0.3)).value();
    run(*world, 8);
    const std::vector<Vec3> before(world->node_positions(sheet).begin(), world->node_positions(sheet).end());
    run(*world, 4);
    double drift = 0, deepest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 p = world->node_positions(sheet)[i];
        drift = std::max(drift, length(p - before[i]));
        const Vec3 inside{0.3 - std::fabs(p.x), mattress_size.y - p.y, 0.3 - std::fabs(p.z)};
        deepest = std::max(deepest, std::min({inside.x, inside.y, inside.z}));
    }
    EXPECT_LT(drift, 0.01);
    EXPECT_LT(deepest, 0.005);
    EXPECT_TRUE(world->is_asleep(sheet));
    EXPECT_TRUE(world->is_asleep(solid));
}

TEST(ClothOnSolid, ABoxLiesOnABlanketOnAMattress) {
    for (const double mass : {0.2, 10.0}) {
        const auto world = make_world({});
        add_plane(*world, {});
        const DeformableHandle solid = world->create_deformable(mattress(2e4)).value();
        const DeformableHandle sheet = world->create_deformable(blanket(0.5, 0.4, 0.17)).value();
        run(*world, 2);
        BodyDefinition box{.shape = world->create_shape(BoxShape{{0.15, 0.05, 0.15}}).value(),
                           .position = {0, 0.22, 0},
                           .mass = {.mass = mass}};
        const BodyHandle handle = world->create_body(box).value();
        run(*world, 6);
        EXPECT_NE(world->sleep_state(handle), SleepState::active) << mass;
        EXPECT_TRUE(world->is_asleep(sheet)) << mass;
        const double way = mass * g / (0.3 * 0.3) / 2e4 * mattress_size.y;
        const double sunk = mattress_size.y + 0.05 - world->pose(handle).position.y;
        EXPECT_LT(sunk, 1.1 * way) << mass;
        EXPECT_GT(sunk, 0.6 * way - 0.006) << mass;
        for (const Vec3 p : world->node_positions(sheet)) EXPECT_TRUE(is_finite(p));
        EXPECT_LT(length(world->center_of_mass(solid) - Vec3{0, mattress_size.y / 2, 0}), 0.02);
    }
}

TEST(ClothOnSolid, TheSameBitsForAnyNumberOfWorkers) {
    std::vector<Vec3> first;
    for (const int workers : {1, 4}) {
        WorldSettings settings;
        settings.workers = workers;
        const auto world = make_world(settings);
        add_plane(*world, {});
        const DeformableHandle solid = world->create_deformable(mattress(2e4)).value();
        const DeformableHandle sheet = world->create_deformable(blanket(0.8, 0.4, 0.2)).value();
        run(*world, 1.5);
        std::vector<Vec3> nodes(world->node_positions(solid).begin(), world->node_positions(solid).end());
        nodes.insert(nodes.end(), world->node_positions(sheet).begin(), world->node_positions(sheet).end());
        if (workers == 1) first = nodes;
        EXPECT_EQ(nodes, first) << workers;
    }
}

TEST(RopeOnSolid, ARopeLiesAcrossAMattress) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    ASSERT_TRUE(world->create_deformable(mattress(2e4)).ok());
    const auto rope = rope_between({-0.5, 0.2, 0}, {0.5, 0.2, 0}, 0.04, {.rayleigh_damping = 0.01});
    const DeformableHandle handle = world->create_deformable(rope).value();
    run(*world, 6);
    for (const Vec3 p : world->node_positions(handle)) {
        if (std::fabs(p.x) < 0.27) {
            EXPECT_NEAR(p.y, mattress_size.y + 0.006, 0.008);
        }
    }
}

}  // namespace
}  // namespace embody::physics
