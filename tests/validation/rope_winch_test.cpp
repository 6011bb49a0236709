// SPDX-License-Identifier: MIT
// A drum that turns and winds up a rope with a load; ropes whose ends are twisted, for any number of workers.
#include <gtest/gtest.h>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

BodyHandle load_of(World& world, double mass, Vec3 place) {
    BodyDefinition body{
        .kind = BodyKind::dynamic_body, .shape = world.create_shape(SphereShape{0.03}).value(), .position = place};
    body.mass.mass = mass;
    return world.create_body(body).value();
}

// After a turn the load has come up by the length that went on the drum, 2π (R + r); from then on the rope lies on
// itself, a diameter further out.
TEST(RopeWinch, ATurningDrumLiftsALoad) {
    const double radius = 0.1, rope_radius = 4e-3, speed = 2;  // rad/s
    for (const double mass : {1.0, 5.0, 100.0}) {
        const auto world = make_world({.sleeping = false});
        BodyDefinition drum{.kind = BodyKind::kinematic_body,
                            .shape = world->create_shape(CylinderShape{radius, 0.1}).value(),
                            .rotation = from_axis_angle({1, 0, 0}, pi / 2)};
        drum.angular_velocity = {0, 0, speed};
        const BodyHandle turning = world->create_body(drum).value();
        const double side = radius + rope_radius, outer = side + 2 * rope_radius;
        auto rope = rope_between({side, 0, 0}, {side, -2, 0}, 0.02,
                                 {.linear_density = 0.05, .axial_stiffness = 3e5, .rayleigh_damping = 0.01});
        rope.contact_radius = rope_radius;
        rope.material = {.friction_static = 0.5, .friction_dynamic = 0.5};
        const auto last = static_cast<std::uint32_t>(rope.nodes.size() - 1);
        const BodyHandle load = load_of(*world, mass, {side, -2, 0});
        const Vec3 on_drum = rotate_inverse(drum.rotation, {side, 0, 0});
        rope.attachments = {{0, turning, on_drum}, {last, load, {}}};
        const DeformableHandle line = world->create_deformable(rope).value();
        run(*world, 0.5);
        const double begin = world->pose(load).position.y;
        run(*world, 4);
        const double first = 2 * pi - 0.5 * speed, second = 4.5 * speed - 2 * pi;  // rad, of each turn
        const double lifted = world->pose(load).position.y - begin;
        EXPECT_NEAR(lifted / (side * first + outer * second), 1, 0.025) << mass;
        EXPECT_NEAR(world->linear_velocity(load).y, outer * speed, 0.1 * outer * speed) << mass;
        double mean = 0;
        for (int i = 0; i < 60; ++i) {
            world->step();
            mean += world->rope_tensions(line).back() / 60;
        }
        EXPECT_NEAR(mean / (gravity * mass), 1, 0.03) << mass;
        for (const Vec3 node : world->node_positions(line))
            EXPECT_GT(std::hypot(node.x, node.y), radius + 0.5 * rope_radius) << mass;
    }
}

// Clamped between two bodies, of which the second turns.
struct TwistedRope {
    DeformableDefinition definition;
    DeformableHandle rope;
    BodyHandle upper, lower;
    std::uint32_t last = 0;

    TwistedRope(World& world, Vec3 place, double spin) {
        BodyDefinition end{.kind = BodyKind::kinematic_body,
                           .shape = world.create_shape(SphereShape{0.01}).value(),
                           .position = place};
        upper = world.create_body(end).value();
        end.position = place - Vec3{0, 0.5, 0};
        end.angular_velocity = {0, spin, 0};
        lower = world.create_body(end).value();
        definition = rope_between(place, end.position, 0.025,
                                  {.bend_rigidity = 1e-3, .twist_rigidity = 1e-3, .rayleigh_damping = 0.01});
        last = static_cast<std::uint32_t>(definition.nodes.size() - 1);
        definition.attachments = {{0, upper, {}}, {last, lower, {}}};
        definition.clamps = {{0, {0, -1, 0}}, {last, {0, -1, 0}}};
        rope = world.create_deformable(definition).value();
    }
};

TEST(RopeTwistInWorld, StaysWhereAnotherThingTakesAClampedEnd) {
    const auto world = make_world({.gravity = {}, .sleeping = false});
    const TwistedRope twisted(*world, {0, 1, 0}, 2);
    run(*world, 2);
    const double angle = world->rope_twists(twisted.rope)[0].angle;
    ASSERT_NEAR(std::fabs(angle), 4, 0.05);
    // A hand that stands still takes the end, held by other axes.
    BodyDefinition hand{.kind = BodyKind::kinematic_body,
                        .shape = world->create_shape(SphereShape{0.01}).value(),
                        .position = {0, 0.5, 0},
                        .rotation = from_axis_angle({0, 0, 1}, 0.7)};
    const BodyHandle held = world->create_body(hand).value();
    const Clamp there{twisted.last, rotate_inverse(hand.rotation, {0, -1, 0})};
    ASSERT_TRUE(world->set_attachments(twisted.rope, {{0, twisted.upper, {}}, {twisted.last, held, {}}},
                                       {twisted.definition.clamps[0], there}));
    run(*world, 1);
    EXPECT_NEAR(world->rope_twists(twisted.rope)[0].angle, angle, 1e-3);
    // And gives it back to what has turned on meanwhile: from there on it is twisted further.
    ASSERT_TRUE(world->set_attachments(twisted.rope, twisted.definition.attachments, twisted.definition.clamps));
    run(*world, 1);
    EXPECT_NEAR(std::fabs(world->rope_twists(twisted.rope)[0].angle), std::fabs(angle) + 2, 0.1);
    // Let go altogether it is untwisted, and begins so anew.
    ASSERT_TRUE(world->set_attachments(twisted.rope, twisted.definition.attachments, {twisted.definition.clamps[0]}));
    run(*world, 0.5);
    ASSERT_TRUE(world->set_attachments(twisted.rope, twisted.definition.attachments, twisted.definition.clamps));
    world->step();
    EXPECT_LT(std::fabs(world->rope_twists(twisted.rope)[0].angle), 0.1);
}

TEST(RopeTwistInWorld, SameBitsForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 4}) {
        const auto world = make_world({.workers = workers});
        add_plane(*world, friction(0.5));
        for (int i = 0; i < 4; ++i) {
            const TwistedRope twisted(*world, {0.02 * i, 0.6, 0}, 20 + i);
            ASSERT_FALSE(twisted.rope.is_null());
        }
        auto sheet = cloth_rectangle(1, 1, 0.03, {.area_density = 0.3});  // more than 1,000 nodes
        sheet.pose.position = {0, 0.05, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
        run(*world, 0.5);
        hashes.push_back(world->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace embody::physics
