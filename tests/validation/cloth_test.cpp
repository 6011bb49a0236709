// SPDX-License-Identifier: MIT
// Sheets and ropes in the world: with rigid bodies, asleep, on several threads.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/contact/nearest_points.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using namespace deformable;

BodyHandle add_body(World& world, const ShapeDefinition& shape, Vec3 position, double mass = 0, Quat rotation = {}) {
    BodyDefinition body{.kind = mass > 0 ? BodyKind::dynamic_body : BodyKind::static_body,
                        .shape = world.create_shape(shape).value(),
                        .position = position,
                        .rotation = rotation};
    if (mass > 0) body.mass.mass = mass;
    return world.create_body(body).value();
}

DeformableDefinition tablecloth(double height, double edge = 0.05) {
    auto cloth = cloth_rectangle(1.2, 1.2, edge, {.area_density = 0.25, .rayleigh_damping = 0.01});
    cloth.pose.position = {0, height, 0};
    return cloth;
}

double lowest(std::span<const Vec3> nodes) {
    double y = 1e9;
    for (const Vec3 node : nodes) y = std::min(y, node.y);
    return y;
}

TEST(ClothInWorld, ATableclothFallsOverATableStaysAndSleeps) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    const Vec3 half{0.4, 0.35, 0.4};
    add_body(*world, BoxShape{half}, {0, half.y, 0});
    const DeformableHandle cloth = world->create_deformable(tablecloth(0.8)).value();
    run(*world, 6);
    const std::vector<Vec3> before(world->node_positions(cloth).begin(), world->node_positions(cloth).end());
    run(*world, 10);
    const auto after = world->node_positions(cloth);
    double drift = 0, deepest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        drift = std::max(drift, length(after[i] - before[i]));
        const Vec3 inside = half - abs(after[i] - Vec3{0, half.y, 0});
        deepest = std::max(deepest, std::min({inside.x, inside.y, inside.z}));
    }
    EXPECT_LT(drift, 0.01);
    EXPECT_LT(deepest, 1e-3);
    EXPECT_NEAR(lowest(after), 0.7 - 0.25, 0.1);
    EXPECT_TRUE(world->is_asleep(cloth));
}

// How far the point is above the sheet, m, where it is on its lower side: that from which `inside` is seen.
double height_above(std::span<const Vec3> nodes, const Cloth& cloth, Vec3 point, Vec3 inside) {
    double nearest = 1e9, height = 0;
    for (const auto& [a, b, c] : cloth.triangles) {
        const auto weight = nearest_weights(point, nodes[a], nodes[b], nodes[c]);
        const Vec3 away = point - (weight[0] * nodes[a] + weight[1] * nodes[b] + weight[2] * nodes[c]);
        if (length(away) >= nearest) continue;
        nearest = length(away);
        const Vec3 normal = normalized(cross(nodes[b] - nodes[a], nodes[c] - nodes[a]));
        height = dot(normal, away) * (dot(normal, point - inside) < 0 ? -1 : 1);
    }
    return height;
}

TEST(ClothInWorld, NoEdgeOrCornerComesThroughATablecloth) {
    const auto world = make_world({});
    const Vec3 half{0.4, 0.35, 0.4};
    add_body(*world, BoxShape{half}, {0, half.y, 0});
    const DeformableDefinition sheet = tablecloth(0.8);
    const DeformableHandle cloth = world->create_deformable(sheet).value();
    run(*world, 2);
    double most = energy(*world);
    for (int i = 0; i < 6; ++i) {
        run(*world, 1);
        EXPECT_LT(energy(*world), most + 0.005 * most) << i;
        most = std::min(most, energy(*world));
    }
    EXPECT_TRUE(world->is_asleep(cloth));
    const std::span<const Vec3> nodes = world->node_positions(cloth);
    for (int i = -40; i <= 40; ++i) {
        const double along = 0.4 * i / 40;
        for (const Vec3 rim :
             {Vec3{along, 0.7, 0.4}, Vec3{along, 0.7, -0.4}, Vec3{0.4, 0.7, along}, Vec3{-0.4, 0.7, along}})
            EXPECT_LT(height_above(nodes, std::get<Cloth>(sheet.matter), rim, {0, 0.35, 0}), 0)
                << rim.x << " " << rim.z;
    }
}

TEST(ClothInWorld, RestsOnACornerAndOnABall) {
    const Quat on_a_corner = from_two_vectors(Vec3{1, 1, 1} / std::sqrt(3.0), Vec3{0, 1, 0});
    for (const bool is_box : {true, false}) {
        const auto world = make_world({});
        const ShapeDefinition shape = is_box ? ShapeDefinition(BoxShape{{0.25, 0.25, 0.25}}) : SphereShape{0.4};
        const BodyHandle body = add_body(*world, shape, {0, 0.5, 0}, 0, on_a_corner);
        // Too small for folds that press on each other, which keep a sheet awake.
        auto sheet = cloth_rectangle(0.5, 0.5, 0.025, {.area_density = 0.25, .rayleigh_damping = 0.01});
        sheet.pose.position = {0, 0.95, 0};
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        const double start = energy(*world);
        run(*world, 12);
        EXPECT_LT(energy(*world), start) << is_box;
        EXPECT_TRUE(world->is_asleep(cloth)) << is_box;
        const double top = 0.5 + (is_box ? 0.25 * std::sqrt(3.0) : 0.4);
        const std::span<const Vec3> nodes = world->node_positions(cloth);
        EXPECT_LT(height_above(nodes, std::get<Cloth>(sheet.matter), {0, top, 0}, world->pose(body).position), 0)
            << is_box;
    }
}

TEST(ClothInWorld, ABoxOnTheTableclothStandsStill) {
    for (const double mass : {0.3, 300.0}) {
        const auto world = make_world({});
        add_body(*world, BoxShape{{0.4, 0.35, 0.4}}, {0, 0.35, 0});
        const DeformableHandle cloth = world->create_deformable(tablecloth(0.71)).value();
        run(*world, 2);
        const BodyHandle box = add_body(*world, BoxShape{{0.1, 0.1, 0.1}}, {0.05, 0.85, 0}, mass);
        run(*world, 3);
        const Vec3 start = world->pose(box).position;
        run(*world, 4);
        EXPECT_LT(length(world->pose(box).position - start), 1e-4) << mass;
        EXPECT_NEAR(world->pose(box).position.y, 0.802, 1e-4) << mass;
        for (const Vec3 node : world->node_positions(cloth)) EXPECT_TRUE(is_finite(node));
    }
}

TEST(ClothInWorld, ATrampolineThrowsABallBackAndThenHoldsIt) {
    auto sheet = cloth_rectangle(1, 1, 0.05, {.area_density = 0.3, .stretch_stiffness = 3000, .shear_stiffness = 1000});
    for (std::uint32_t i = 0; i < sheet.nodes.size(); ++i) {
        if (std::max(std::fabs(sheet.nodes[i].x), std::fabs(sheet.nodes[i].z)) > 0.499) sheet.pinned.push_back(i);
    }
    for (const double mass : {0.5, 50.0}) {
        const auto world = make_world({});
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        const BodyHandle ball = add_body(*world, SphereShape{0.1}, {0, 0.6, 0}, mass);
        double least = 1, highest_after = -1;
        for (int i = 0; i < 120; ++i) {
            world->step();
            const double y = world->pose(ball).position.y;
            if (y < least) {
                least = y;
                highest_after = -1;
            }
            highest_after = std::max(highest_after, y);
        }
        EXPECT_LT(least, 0.1) << mass;
        EXPECT_GT(highest_after, least + 0.1) << mass;
        EXPECT_LT(highest_after, 0.6) << mass;
        run(*world, 20);
        EXPECT_LT(length(world->linear_velocity(ball)), 0.05) << mass;
        EXPECT_LT(std::hypot(world->pose(ball).position.x, world->pose(ball).position.z), 0.06) << mass;
        EXPECT_GT(world->pose(ball).position.y, lowest(world->node_positions(cloth))) << mass;
    }
}

TEST(ClothInWorld, SameBitsForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 3}) {
        const auto world = make_world({.workers = workers});
        add_body(*world, BoxShape{{0.4, 0.35, 0.4}}, {0, 0.35, 0});
        ASSERT_TRUE(world->create_deformable(tablecloth(0.8, 0.03)).ok());
        add_body(*world, SphereShape{0.1}, {0.1, 1.1, 0}, 1);
        run(*world, 1);
        hashes.push_back(world->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(RopeInWorld, ABallOnARopeSwings) {
    // Attached on its surface, which turns: a body of finite size is a compound pendulum.
    for (const double mass : {1.0, 1000.0}) {
        const auto world = make_world({});
        const BodyHandle ball = add_body(*world, SphereShape{0.1}, {1.1, 2, 0}, mass);
        auto rope = rope_between({0, 2, 0}, {1, 2, 0}, 0.05, {.axial_stiffness = 1e6, .rayleigh_damping = 0.01});
        rope.pinned = {0};
        rope.attachments = {{.node = 20, .body = ball, .anchor = {-0.1, 0, 0}}};
        const DeformableHandle handle = world->create_deformable(rope).value();
        double lowest_y = 2;
        for (int i = 0; i < 60; ++i) {
            world->step();
            lowest_y = std::min(lowest_y, world->pose(ball).position.y);
        }
        EXPECT_NEAR(lowest_y, 0.9, 0.05) << mass;  // it falls through its arc
        // Nothing but the rope's own damping and the method's stops it: it may only get lower, on the same circle.
        run(*world, 20);
        EXPECT_LT(world->pose(ball).position.y, 2) << mass;
        const double stretched = 1.1 + mass * gravity / 1e6;
        EXPECT_NEAR(length(world->pose(ball).position - Vec3{0, 2, 0}), stretched, 0.02) << mass;
        EXPECT_NEAR(length(world->node_positions(handle)[20] - world->pose(ball).position), 0.1, 2e-3) << mass;
    }
}

TEST(ClothInWorld, FoldsOnABallGainNoEnergyAndSleep) {
    // Layers that lie on each other are held apart by what the sheet's own stretch knows of.
    const auto world = make_world({});
    add_plane(*world, {});
    add_body(*world, SphereShape{0.3}, {0, 0.3, 0});
    auto sheet = cloth_rectangle(1.2, 1.2, 0.03, {.rayleigh_damping = 0.01});
    sheet.pose.position = {0, 0.62, 0};
    sheet.contact_radius = 3.5e-3;
    const DeformableHandle handle = world->create_deformable(sheet).value();
    const auto energy = [&] { return world->conserved().kinetic_energy + world->conserved().potential_energy; };
    run(*world, 1);
    double before = energy();
    for (int i = 0; i < 10; ++i) {
        run(*world, 0.5);
        EXPECT_LT(energy(), 1.002 * before) << i;
        before = energy();
    }
    EXPECT_TRUE(world->is_asleep(handle));
}

TEST(RopeInWorld, ARopeOverABoxEdgeDoesNotPassThrough) {
    // Segments longer than the box's corner is wide: only contacts between the nodes can hold it.
    const auto world = make_world({});
    add_body(*world, BoxShape{{0.05, 0.05, 0.5}}, {0.03, 0, 0});
    auto rope =
        rope_between({-1, 0.07, 0.01}, {1, 0.07, 0.01}, 0.25, {.axial_stiffness = 1e4, .rayleigh_damping = 0.02});
    rope.contact_radius = 0.005;
    const DeformableHandle handle = world->create_deformable(rope).value();
    run(*world, 1);
    double highest = -10;
    for (const Vec3 node : world->node_positions(handle)) highest = std::max(highest, node.y);
    EXPECT_GT(highest, 0.02);
}

}  // namespace
}  // namespace embody::physics
