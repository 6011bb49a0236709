// SPDX-License-Identifier: MIT
// Ropes, sheets and solids that begin inside of bodies: they come out gently, and no energy comes from nowhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

double fastest(const World& world, DeformableHandle deformable) {
    double most = 0;
    for (const Vec3 v : world.node_velocities(deformable)) most = std::max(most, length(v));
    return most;
}

struct Motion {
    double highest_energy = 0;  // above that of the start, J
    double fastest = 0;         // m/s
};

Motion watch(World& world, DeformableHandle deformable, double seconds) {
    Motion motion;
    const double start = energy(world);
    for (int i = 0; i < std::lround(seconds / world.settings().time_step); ++i) {
        world.step();
        motion.highest_energy = std::max(motion.highest_energy, energy(world) - start);
        motion.fastest = std::max(motion.fastest, fastest(world, deformable));
    }
    return motion;
}

DeformableDefinition limp_rope(Vec3 from, Vec3 to) {
    DeformableDefinition rope =
        rope_between(from, to, 0.04, {.linear_density = 0.3, .axial_stiffness = 1e5, .rayleigh_damping = 0.01});
    rope.contact_radius = 0.01;
    return rope;
}

TEST(BeginsInside, ARopeBelowTheFloorIsLiftedByItsDepth) {
    for (const double depth : {0.0, 0.02, 0.1}) {
        const auto world = make_world({.sleeping = false});
        add_plane(*world, friction(0.5));
        const DeformableHandle rope = world->create_deformable(limp_rope({-0.4, -depth, 0}, {0.4, -depth, 0})).value();
        const Motion motion = watch(*world, rope, 3);
        const double weight = gravity * world->mass(rope), lift = depth + 0.01;
        EXPECT_LT(motion.highest_energy, weight * lift + 0.5 * world->mass(rope) * 0.4 * 0.4) << depth;
        EXPECT_LT(motion.fastest, 0.5) << depth;
        for (const Vec3 node : world->node_positions(rope)) EXPECT_NEAR(node.y, 0.01, 1e-3) << depth;
        EXPECT_LT(fastest(*world, rope), 0.01) << depth;
    }
}

TEST(BeginsInside, ARopeThroughABoxComesOut) {
    for (const double mass : {0.0, 1.0, 100.0}) {  // 0: a static one
        const auto world = make_world({.sleeping = false});
        add_plane(*world, friction(0.5));
        BodyDefinition box{.kind = mass > 0 ? BodyKind::dynamic_body : BodyKind::static_body,
                           .shape = world->create_shape(BoxShape{{0.2, 0.2, 0.2}}).value(),
                           .position = {0, 0.2, 0}};
        if (mass > 0) box.mass.mass = mass;
        ASSERT_TRUE(world->create_body(box).ok());
        const DeformableHandle rope = world->create_deformable(limp_rope({0.05, 0.11, 0.02}, {0.1, 1.1, 0})).value();
        const Motion motion = watch(*world, rope, 4);
        const double inside = 0.29, weight = gravity * 0.3 * inside;  // lifted out through the top
        EXPECT_LT(motion.highest_energy, weight * inside / 2) << mass << " kg";
        EXPECT_LT(motion.fastest, 6) << mass << ": what falls 1 m";
        EXPECT_LT(fastest(*world, rope), 0.3) << mass;
    }
}

// It stands on its end in a box of a thousandth of its mass: they fall together, and nothing more.
TEST(BeginsInside, AHeavyRopeDoesNotKickALightBox) {
    const auto world = make_world({.sleeping = false});
    add_plane(*world, friction(0.5));
    BodyDefinition light{.shape = world->create_shape(BoxShape{{0.05, 0.05, 0.05}}).value(), .position = {0, 0.3, 0}};
    light.mass.mass = 0.05;
    ASSERT_TRUE(world->create_body(light).ok());
    DeformableDefinition heavy = rope_between({0, -0.2, 0}, {0, 0.4, 0}, 0.04,
                                              {.linear_density = 83, .axial_stiffness = 1e5, .rayleigh_damping = 0.01});
    heavy.contact_radius = 0.01;
    ASSERT_TRUE(world->create_deformable(heavy).ok());
    // What it gains as it is lifted out of the floor.
    const double start = energy(*world), lift = 83 * 0.6 * gravity * 0.21;
    for (int k = 0; k < 240; ++k) {
        world->step();
        EXPECT_LT(energy(*world), start + lift) << k;
    }
}

// Springs that lift it out would give the box, which bounces between the rope and the floor, more and more energy.
TEST(BeginsInside, ARopeShootsNoBoxAway) {
    for (const double density : {1.0, 20.0, 83.0}) {  // kg/m
        for (const double low : {-0.2, -0.15, -0.1, -0.05, 0.0}) {
            const auto world = make_world({.sleeping = false});
            add_plane(*world, friction(0.5));
            const BodyHandle box =
                world
                    ->create_body({.shape = world->create_shape(BoxShape{{0.05, 0.05, 0.05}}).value(),
                                   .position = {0, 0.3, 0},
                                   .mass = {.mass = 1}})
                    .value();
            DeformableDefinition rope =
                rope_between({0, low, 0}, {0, 0.4, 0}, 0.04,
                             {.linear_density = density, .axial_stiffness = 1e5, .rayleigh_damping = 0.01});
            rope.contact_radius = 0.01;
            ASSERT_TRUE(world->create_deformable(rope).ok());
            double fastest = 0;  // m/s
            for (int k = 0; k < 120; ++k) {
                world->step();
                fastest = std::max(fastest, length(world->linear_velocity(box)));
            }
            EXPECT_LT(fastest, 1.2 * std::sqrt(2 * gravity * 0.25)) << density << " kg/m from " << low;
        }
    }
}

TEST(BeginsInside, ASheetInABoxComesOutOrStays) {
    const auto world = make_world({.sleeping = false});
    BodyDefinition box{.kind = BodyKind::static_body,
                       .shape = world->create_shape(BoxShape{{0.15, 0.15, 0.15}}).value()};
    ASSERT_TRUE(world->create_body(box).ok());
    auto definition = cloth_rectangle(0.25, 0.25, 0.03, {.area_density = 0.2, .rayleigh_damping = 0.01});
    definition.pose.position = {0, 0.03, 0};
    definition.pose.rotation = from_axis_angle({0, 0, 1}, 0.1);
    const DeformableHandle sheet = world->create_deformable(definition).value();
    const Motion motion = watch(*world, sheet, 2);
    EXPECT_LT(motion.highest_energy, gravity * world->mass(sheet) * 0.15);
    EXPECT_LT(motion.fastest, 1);
}

// The faces around it would pull it apart: it leaves by the shortest way, here all equal, so up, and lies there whole.
TEST(BeginsInside, ASoftCubeLeavesABoxWhole) {
    const auto world = make_world({});
    BodyDefinition box{.kind = BodyKind::static_body,
                       .shape = world->create_shape(BoxShape{{0.15, 0.15, 0.15}}).value()};
    ASSERT_TRUE(world->create_body(box).ok());
    DeformableDefinition cube = tetrahedral_brick({0.2, 0.2, 0.2}, {4, 4, 4});
    SoftSolid& matter = std::get<SoftSolid>(cube.matter);
    matter.density = 1000;
    matter.youngs_modulus = 1e5;
    matter.rayleigh_damping = 0.02;
    cube.pose.position = {-0.1, -0.1, -0.1};
    const DeformableHandle soft = world->create_deformable(cube).value();
    const Motion motion = watch(*world, soft, 3);
    const double lift = 0.25 + 0.01;
    EXPECT_LT(motion.highest_energy, world->mass(soft) * (gravity * lift + 0.5 * 0.5 * 0.5));
    EXPECT_LT(motion.fastest, 1);
    EXPECT_NEAR(world->center_of_mass(soft).y, 0.25, 0.01);
    EXPECT_TRUE(world->is_asleep(soft));
}

// A rope may go through what it is tied to: a ball on a string, whose middle holds the string's end.
TEST(BeginsInside, ARopeTiedToTheMiddleOfABallPullsThere) {
    for (const double mass : {0.01, 1.0, 100.0}) {
        const auto world = make_world({.sleeping = false});
        BodyDefinition ball{.kind = BodyKind::dynamic_body,
                            .shape = world->create_shape(SphereShape{0.15}).value(),
                            .position = {0, 1, 0}};
        ball.mass.mass = mass;
        const BodyHandle body = world->create_body(ball).value();
        DeformableDefinition definition = limp_rope({0, 2, 0}, {0, 1, 0});
        definition.pinned = {0};
        definition.attachments = {{static_cast<std::uint32_t>(definition.nodes.size() - 1), body, {}}};
        const DeformableHandle rope = world->create_deformable(definition).value();
        const Motion motion = watch(*world, rope, 3);
        EXPECT_LT(motion.highest_energy, 1e-3 * gravity * (mass + world->mass(rope))) << mass;
        const auto tension = world->rope_tensions(rope);
        EXPECT_NEAR(tension.back() / (gravity * (mass + 0.02 * 0.3)), 1, 0.02) << mass;
    }
}

}  // namespace
}  // namespace embody::physics
