// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

constexpr double bad_numbers[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity(), 1e38, 1e-310};

struct Scene {
    std::unique_ptr<World> world = make_world();
    ShapeHandle ball = world->create_shape(SphereShape{0.5}).value();
    BodyHandle body = world->create_body({.shape = ball, .position = {0, 3, 0}}).value();
    BodyHandle other = world->create_body({.shape = ball, .position = {5, 3, 0}}).value();
};

TEST(Setters, RefuseBadNumbersByNameAndChangeNothing) {
    for (const double bad : bad_numbers) {
        Scene scene;
        World& world = *scene.world;
        const std::uint64_t before = world.state_hash();
        const auto refused = [&](const Result<void>& result, const std::string& field) {
            ASSERT_FALSE(result) << field << " took " << bad;
            EXPECT_NE(result.error().where.find(field), std::string::npos) << result.error().message();
        };
        refused(world.set_pose(scene.body, {{bad, 0, 0}, {}}), "position");
        refused(world.set_velocity(scene.body, {0, bad, 0}, {}), "linear.y");
        refused(world.set_velocity(scene.body, {}, {0, 0, bad}), "angular.z");
        refused(world.set_force(scene.body, {bad, 0, 0}, {}), "force");
        refused(world.set_force(scene.body, {}, {bad, 0, 0}), "torque");
        refused(world.apply_impulse(scene.body, {bad, 0, 0}), "impulse");
        refused(world.apply_impulse(scene.body, {1, 0, 0}, Vec3{bad, 0, 0}), "at_world_point");
        refused(world.apply_angular_impulse(scene.body, {bad, 0, 0}), "impulse");
        refused(world.apply_force(scene.body, {bad, 0, 0}), "force");

        BodyDefinition definition = world.body(scene.body).value();
        definition.mass.mass = bad;
        refused(world.set_body(scene.body, definition), "mass.mass");
        definition = world.body(scene.body).value();
        definition.material.restitution = bad;
        refused(world.set_body(scene.body, definition), "material.restitution");
        WorldSettings settings;
        settings.time_step = bad;
        refused(world.set_settings(settings), "time_step");
        EXPECT_FALSE(World::create(settings));
        EXPECT_FALSE(world.create_body({.shape = scene.ball, .position = {0, 0, bad}}));
        EXPECT_EQ(world.state_hash(), before);
    }
}

TEST(Setters, RefuseStaleHandles) {
    Scene scene;
    ASSERT_TRUE(scene.world->destroy_body(scene.body));
    EXPECT_FALSE(scene.world->set_velocity(scene.body, {}, {}));
    EXPECT_FALSE(scene.world->destroy_body(scene.body));
    EXPECT_FALSE(scene.world->body(scene.body));
    EXPECT_FALSE(scene.world->set_enabled(BodyHandle{}, true));
    EXPECT_FALSE(scene.world->create_joint({.joint = BallJoint{}, .body_b = scene.body}));
    EXPECT_FALSE(scene.world->create_body({.shape = ShapeHandle{99, 1}}));
}

TEST(Setters, RefuseWhatNoMatterCouldBe) {
    Scene scene;
    World& world = *scene.world;
    EXPECT_FALSE(world.create_body({.shape = scene.ball, .mass = {.inertia = Mat3::diagonal({1, 1, 3})}}));
    EXPECT_FALSE(world.create_body({.shape = scene.ball, .mass = {.inertia = Mat3::diagonal({1, 1, -1})}}));
    EXPECT_FALSE(world.create_body({.shape = scene.ball, .rotation = {0, 0, 0, 0}}));
    EXPECT_FALSE(world.create_body({.position = {0, 0, 0}})) << "neither shape nor mass";
    EXPECT_FALSE(
        world.create_body({.shape = scene.ball, .material = {.friction_static = 0.1, .friction_dynamic = 0.3}}));
    const auto plane = world.create_shape(PlaneShape{}).value();
    EXPECT_FALSE(world.create_body({.shape = plane})) << "a plane can only be static";
    EXPECT_FALSE(world.destroy_shape(scene.ball)) << "still in use";
}

TEST(World, BodyPushedOutOfTheNumbersIsFrozenAndReported) {
    Scene scene;
    World& world = *scene.world;
    WorldSettings settings = world.settings();
    settings.max_linear_speed = 1e6;
    ASSERT_TRUE(world.set_settings(settings));
    const auto light = world.create_body({.shape = scene.ball, .position = {-5, 3, 0}, .mass = {.mass = 1e-6}}).value();
    ASSERT_TRUE(world.apply_force(light, {1e15, 0, 0}));
    std::uint32_t limits = 0;
    for (int i = 0; i < 5; ++i) limits |= world.step().limits;
    EXPECT_NE(limits & (static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen) |
                        static_cast<std::uint32_t>(StepLimit::linear_speed_clamped)),
              0u);
    EXPECT_TRUE(is_finite(world.pose(light)));
    EXPECT_TRUE(is_finite(world.pose(scene.body)));
}

}  // namespace
}  // namespace embody::physics
