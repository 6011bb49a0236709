// SPDX-License-Identifier: MIT
// Deformables that are placed, moved and changed from outside while the world runs.
#include <gtest/gtest.h>

#include <algorithm>

#include <limits>

#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

DeformableDefinition soft_brick() {
    DeformableDefinition definition = tetrahedral_brick({0.4, 0.2, 0.3}, {4, 2, 3});
    auto& solid = std::get<SoftSolid>(definition.matter);
    solid.density = 100;
    solid.youngs_modulus = 2e4;
    solid.rayleigh_damping = 0.01;
    return definition;
}

Quat turn(Vec3 axis, double angle) { return from_axis_angle(normalized(axis), angle); }

double distance(Quat a, Quat b) {
    const Quat between = conjugate(a) * b;
    return 2 * length(Vec3{between.x, between.y, between.z});
}

class DeformableChanges : public testing::Test {
protected:
    std::unique_ptr<World> world_ = make_world();
    DeformableHandle add(const DeformableDefinition& definition) {
        auto handle = world_->create_deformable(definition);
        EXPECT_TRUE(handle) << handle.error().message();
        return handle.value();
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world_->step();
    }
};

TEST_F(DeformableChanges, ThePoseIsThatOfTheFrameAlsoAfterManyTurns) {
    DeformableDefinition definition = soft_brick();
    definition.pose = {{1, 2, 3}, turn({1, 2, 0.5}, 3.1)};
    definition.gravity_factor = 0;
    definition.angular_velocity = {0, 4, 0};
    const DeformableHandle brick = add(definition);
    EXPECT_LT(length(world_->pose(brick).position - definition.pose.position), 1e-12);
    EXPECT_LT(distance(world_->pose(brick).rotation, definition.pose.rotation), 1e-12);
    EXPECT_NEAR(world_->mass(brick), 100 * 0.4 * 0.2 * 0.3, 1e-9);

    // It turns about its centre with the spin that it has: momenta are kept.
    const Vec3 center = world_->center_of_mass(brick);
    Quat before = world_->pose(brick).rotation;
    double turned = 0;
    for (int i = 0; i < 240; ++i) {
        world_->step();
        const Quat now = world_->pose(brick).rotation;
        const double step = distance(before, now);
        EXPECT_LT(step, 0.1) << "no jump at step " << i;
        turned += step;
        before = now;
    }
    EXPECT_NEAR(turned, 16, 1);
    EXPECT_LT(length(world_->center_of_mass(brick) - center), 1e-6);
}

TEST_F(DeformableChanges, NodesThatArePlacedFallFromThereAsAnythingDoes) {
    const DeformableHandle brick = add(soft_brick());
    run(5);
    const Transform to{{5, 30, -2}, turn({0, 0, 1}, 2)};
    const Vec3 velocity{3, 1, 0};
    std::vector<Vec3> positions, velocities;
    for (const Vec3 node : world_->deformable(brick)->nodes) {
        positions.push_back(transform_point(to, node));
        velocities.push_back(velocity);
    }
    ASSERT_TRUE(world_->set_nodes(brick, positions, velocities));
    EXPECT_LT(length(world_->pose(brick).position - to.position), 1e-12);
    EXPECT_LT(distance(world_->pose(brick).rotation, to.rotation), 1e-12);
    const Vec3 start = world_->center_of_mass(brick);
    run(30);
    const double t = 0.5;
    const Vec3 expected = start + t * velocity + (t * t / 2) * world_->settings().gravity;
    EXPECT_LT(length(world_->center_of_mass(brick) - expected), 1e-6);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 v = world_->node_velocities(brick)[i];
        EXPECT_LT(length(v - (velocity + t * world_->settings().gravity)), 1e-4) << i;
    }
}

TEST_F(DeformableChanges, OtherMatterGoesOnWhereTheOldOneWas) {
    DeformableDefinition definition = soft_brick();
    definition.pose.position = {0, 10, 0};
    definition.linear_velocity = {2, 0, 1};
    definition.angular_velocity = {1, 2, 0};
    const DeformableHandle brick = add(definition);
    run(10);
    const std::vector<Vec3> positions(world_->node_positions(brick).begin(), world_->node_positions(brick).end());
    const std::vector<Vec3> velocities(world_->node_velocities(brick).begin(), world_->node_velocities(brick).end());
    std::get<SoftSolid>(definition.matter).density = 300;
    std::get<SoftSolid>(definition.matter).youngs_modulus = 1e6;
    definition.gravity_factor = 0;
    ASSERT_TRUE(world_->set_deformable(brick, definition));
    EXPECT_EQ(positions, std::vector<Vec3>(world_->node_positions(brick).begin(), world_->node_positions(brick).end()));
    EXPECT_EQ(velocities,
              std::vector<Vec3>(world_->node_velocities(brick).begin(), world_->node_velocities(brick).end()));
    EXPECT_NEAR(world_->mass(brick), 300 * 0.4 * 0.2 * 0.3, 1e-9);
    const Conserved before = world_->conserved();
    run(60);
    const Conserved after = world_->conserved();
    EXPECT_LT(length(after.linear_momentum - before.linear_momentum), 1e-6 * length(before.linear_momentum));
    EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-2 * length(before.angular_momentum));
}

// Its contacts with another sheet are remembered by the numbers of edges and triangles.
TEST_F(DeformableChanges, ASheetOnAnotherGetsOtherTriangles) {
    DeformableDefinition upper = cloth_rectangle(0.4, 0.4, 0.1, {.area_density = 0.2});
    DeformableDefinition lower = upper;
    for (std::uint32_t i = 0; i < lower.nodes.size(); ++i) lower.pinned.push_back(i);
    upper.pose.position = {0.02, 0.003, 0};
    add(lower);
    const DeformableHandle sheet = add(upper);
    run(30);
    auto& triangles = std::get<Cloth>(upper.matter).triangles;
    const auto is_spare = [&](const auto& triangle) {
        return std::ranges::all_of(triangle, [&](std::uint32_t node) {
            return std::ranges::count_if(triangles, [&](const auto& t) { return std::ranges::count(t, node) > 0; }) > 1;
        });
    };
    const auto spare = std::ranges::find_if(triangles, is_spare);
    ASSERT_NE(spare, triangles.end());
    triangles.erase(spare);
    ASSERT_TRUE(world_->set_deformable(sheet, upper));
    run(30);
    for (const Vec3 node : world_->node_positions(sheet)) EXPECT_NEAR(node.y, 2e-3, 1e-3);
}

TEST_F(DeformableChanges, AHandHoldsItByAttachmentsThatComeAndGo) {
    const DeformableHandle brick = add(soft_brick());
    BodyDefinition hand;
    hand.kind = BodyKind::kinematic_body;
    hand.shape = world_->create_shape(SphereShape{0.01}).value();
    hand.collision_mask = 0;
    hand.position = {0.2, 0.2, 0.15};
    const BodyHandle body = world_->create_body(hand).value();
    std::vector<Attachment> attachments;
    const auto& nodes = world_->deformable(brick)->nodes;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].y > 0.19) attachments.push_back({i, body, nodes[i] - hand.position});
    }
    ASSERT_TRUE(world_->set_attachments(brick, attachments));
    run(240);
    EXPECT_LT(world_->center_of_mass(brick).y, 0.1) << "it sags";
    EXPECT_GT(world_->center_of_mass(brick).y, 0.05) << "but does not fall";
    ASSERT_TRUE(world_->set_attachments(brick, {}));
    run(60);
    EXPECT_LT(world_->center_of_mass(brick).y, -4);
}

TEST_F(DeformableChanges, WrongOnesAreRefusedAndNothingChanges) {
    const DeformableHandle brick = add(soft_brick());
    const std::uint64_t hash = world_->state_hash();
    const std::vector<Vec3> right(world_->deformable(brick)->nodes.size());
    std::vector<Vec3> wrong = right;
    wrong[3].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(world_->set_nodes(brick, std::vector<Vec3>(3), right));
    EXPECT_FALSE(world_->set_nodes(brick, wrong, right));
    EXPECT_FALSE(world_->set_nodes(brick, right, wrong));
    EXPECT_FALSE(world_->set_nodes({}, right, right));
    DeformableDefinition other = tetrahedral_brick({1, 1, 1}, {1, 1, 1});
    EXPECT_FALSE(world_->set_deformable(brick, other));
    other = soft_brick();
    std::get<SoftSolid>(other.matter).density = -1;
    EXPECT_FALSE(world_->set_deformable(brick, other));
    EXPECT_FALSE(world_->set_attachments(brick, {{0, BodyHandle{}, {}}}));
    EXPECT_EQ(world_->state_hash(), hash);
    EXPECT_EQ(world_->mass(DeformableHandle{}), 0);
}

}  // namespace
}  // namespace embody::physics
