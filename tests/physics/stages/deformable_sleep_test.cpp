// SPDX-License-Identifier: MIT
// Deformables that sleep: what happens around one wakes it, what does not concern it leaves its bits as they are, and
// bodies that lie on one wake and sleep with it.
#include <gtest/gtest.h>

#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"

namespace embody::physics {
namespace {

DeformableDefinition brick_at(Vec3 position) {
    DeformableDefinition definition = tetrahedral_brick({0.4, 0.2, 0.4}, {2, 1, 2});
    auto& solid = std::get<SoftSolid>(definition.matter);
    solid.density = 200;
    solid.youngs_modulus = 1e5;
    solid.rayleigh_damping = 0.05;
    definition.pose.position = position;
    return definition;
}

/// A soft brick asleep on a floor, held at one corner by a hand that is still.
struct SleepingBrick {
    std::unique_ptr<World> world = make_world();
    BodyHandle floor = add_box({2, 0.5, 2}, {.kind = BodyKind::static_body, .position = {0, -0.5, 0}});
    BodyHandle hand = add_box({0.01, 0.01, 0.01},
                              {.kind = BodyKind::kinematic_body, .position = {-0.2, 0.001, -0.2}, .collision_mask = 0});
    DeformableHandle brick;

    SleepingBrick() {
        DeformableDefinition definition = brick_at({-0.2, 0.001, -0.2});
        definition.attachments = {{0, hand, {}}};
        brick = world->create_deformable(definition).value();
        for (int i = 0; i < 900 && !world->is_asleep(brick); ++i) world->step();
        EXPECT_TRUE(world->is_asleep(brick));
    }
    BodyHandle add_box(Vec3 half_extents, BodyDefinition definition) const {
        definition.shape = world->create_shape(BoxShape{half_extents}).value();
        return world->create_body(definition).value();
    }
    void run(int steps) const {
        for (int i = 0; i < steps; ++i) world->step();
    }
    std::vector<Vec3> nodes() const {
        const auto positions = world->node_positions(brick);
        return {positions.begin(), positions.end()};
    }
};

TEST(DeformableSleep, IsEndedByWhatHappensAround) {
    using Happening = std::function<void(SleepingBrick&)>;
    const std::vector<std::pair<const char*, Happening>> happenings{
        {"a box that falls on it",
         [](SleepingBrick& scene) {
             scene.add_box({0.1, 0.1, 0.1}, {.position = {0, 0.4, 0}, .linear_velocity = {0, -1, 0}});
         }},
        {"a floor that goes", [](SleepingBrick& scene) { ASSERT_TRUE(scene.world->destroy_body(scene.floor)); }},
        {"a floor that is put lower",
         [](SleepingBrick& scene) {
             ASSERT_TRUE(scene.world->set_pose(scene.floor, {{0, -0.6, 0}, {}}));
         }},
        {"a hand that moves, however slowly",
         [](SleepingBrick& scene) {
             ASSERT_TRUE(scene.world->set_velocity(scene.hand, {0, 0.001, 0}, {}));
         }},
        {"another brick that falls on it",
         [](SleepingBrick& scene) {
             DeformableDefinition other = brick_at({-0.2, 0.25, -0.2});
             other.linear_velocity = {0, -1, 0};
             ASSERT_TRUE(scene.world->create_deformable(other));
         }},
        {"another gravity",
         [](SleepingBrick& scene) {
             ASSERT_TRUE(scene.world->set_settings({.gravity = {0, -5, 0}}));
         }},
        {"other attachments", [](SleepingBrick& scene) { ASSERT_TRUE(scene.world->set_attachments(scene.brick, {})); }},
        {"whoever wakes it", [](SleepingBrick& scene) { ASSERT_TRUE(scene.world->wake(scene.brick)); }}};
    for (const auto& [what, happens] : happenings) {
        SleepingBrick scene;
        happens(scene);
        bool is_woken = false;
        for (int i = 0; i < 20 && !is_woken; ++i) {
            scene.run(1);
            is_woken = !scene.world->is_asleep(scene.brick);
        }
        EXPECT_TRUE(is_woken) << what;
    }
}

TEST(DeformableSleep, IsNotEndedByUnrelatedChanges) {
    using Happening = std::function<void(SleepingBrick&)>;
    const std::vector<std::pair<const char*, Happening>> happenings{
        {"a fast body far away",
         [](SleepingBrick& scene) {
             scene.add_box({0.1, 0.1, 0.1}, {.position = {50, 0.4, 0}, .linear_velocity = {0, -9, 0}});
         }},
        {"one that is in its place but collides with nothing",
         [](SleepingBrick& scene) {
             scene.add_box({0.1, 0.1, 0.1},
                           {.position = {0, 0.4, 0}, .linear_velocity = {0, -9, 0}, .collision_mask = 0});
         }},
        {"one that lies beside it",
         [](SleepingBrick& scene) {
             scene.add_box({0.1, 0.1, 0.1}, {.position = {0.4, 0.1, 0}});
         }},
        {"a brick far away",
         [](SleepingBrick& scene) {
             ASSERT_TRUE(scene.world->create_deformable(brick_at({30, 5, 0})));
         }},
        {"a disabled brick in its place", [](SleepingBrick& scene) {
             DeformableDefinition other = brick_at({-0.2, 0.1, -0.2});
             other.enabled = false;
             ASSERT_TRUE(scene.world->create_deformable(other));
         }}};
    for (const auto& [what, happens] : happenings) {
        SleepingBrick scene;
        const std::vector<Vec3> before = scene.nodes();
        happens(scene);
        scene.run(20);
        EXPECT_TRUE(scene.world->is_asleep(scene.brick)) << what;
        EXPECT_EQ(scene.nodes(), before) << what;
    }
}

TEST(DeformableSleep, IsEndedByWhatPassesCloseNeitherSlowlyNorFarAway) {
    const double radius = DeformableDefinition{}.contact_radius;
    for (const auto& [speed, gap, wakes] :
         {std::tuple{0.03, radius, false}, {0.08, radius, true}, {0.08, 0.1, false}}) {
        SleepingBrick scene;
        scene.add_box(
            {0.05, 0.05, 0.05},
            {.kind = BodyKind::kinematic_body, .position = {0.25 + gap, 0.1, 0}, .linear_velocity = {0, 0, speed}});
        scene.run(5);
        EXPECT_NE(scene.world->is_asleep(scene.brick), wakes) << speed << " m/s at " << gap << " m";
    }
}

TEST(DeformableSleep, IsSharedWithABodyThatLiesOnIt) {
    SleepingBrick scene;
    const BodyHandle box = scene.add_box({0.1, 0.05, 0.1}, {.position = {0, 0.255, 0}, .mass = {.density = 100}});
    const auto both_sleep = [&] {
        return scene.world->is_asleep(scene.brick) && scene.world->sleep_state(box) == SleepState::asleep;
    };
    for (int i = 0; i < 1200 && !both_sleep(); ++i) scene.run(1);
    ASSERT_TRUE(scene.world->is_asleep(scene.brick));
    ASSERT_EQ(scene.world->sleep_state(box), SleepState::asleep);
    const double height = scene.world->pose(box).position.y;
    EXPECT_GT(height, 0.22) << "it is carried";
    // Without what carries it, it falls.
    ASSERT_TRUE(scene.world->destroy_deformable(scene.brick));
    scene.run(15);
    EXPECT_LT(scene.world->pose(box).position.y, height - 0.05);
}

// A sleeper that is pushed wakes before it has moved by itself.
TEST(DeformableSleep, OfABodyIsEndedByABrickThatLiesDownOnIt) {
    SleepingBrick scene;
    ASSERT_TRUE(scene.world->destroy_deformable(scene.brick));
    const BodyHandle box = scene.add_box({0.1, 0.05, 0.1}, {.position = {0, 0.05, 0}, .mass = {.density = 100}});
    for (int i = 0; i < 300 && scene.world->sleep_state(box) != SleepState::asleep; ++i) scene.run(1);
    ASSERT_EQ(scene.world->sleep_state(box), SleepState::asleep);
    ASSERT_TRUE(scene.world->create_deformable(brick_at({-0.2, 0.11, -0.2})));
    bool is_woken = false;
    for (int i = 0; i < 20 && !is_woken; ++i) {
        scene.run(1);
        is_woken = scene.world->sleep_state(box) != SleepState::asleep;
    }
    EXPECT_TRUE(is_woken);
}

}  // namespace
}  // namespace embody::physics
