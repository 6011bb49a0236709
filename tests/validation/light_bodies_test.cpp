// SPDX-License-Identifier: MIT
// Light bodies on the ground under heavy sheets: what bears them bears the sheet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// A box or ball on the ground and a sheet above it, both of random sizes, m and kg.
struct Covered {
    std::unique_ptr<World> world = make_world({});
    BodyHandle body;
    double height = 0;  // of the body's centre when it stands, m
    double ratio = 0;   // of the sheet's mass to the body's

    explicit Covered(unsigned seed) {
        std::mt19937 random(seed);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const auto scaled = [&](double low, double high) { return std::exp(between(std::log(low), std::log(high))); };
        const bool is_plane = seed % 2 == 0;
        const ShapeHandle ground = is_plane ? world->create_shape(PlaneShape{{0, 1, 0}, 0}).value()
                                            : world->create_shape(BoxShape{{3, 0.5, 3}}).value();
        const double ground_height = is_plane ? 0 : -0.5;
        EXPECT_TRUE(
            world->create_body({.kind = BodyKind::static_body, .shape = ground, .position = {0, ground_height, 0}})
                .ok());
        const Vec3 half{between(0.04, 0.15), between(0.04, 0.15), between(0.04, 0.15)};
        const ShapeHandle shape = seed % 4 < 2 ? world->create_shape(BoxShape{half}).value()
                                               : world->create_shape(SphereShape{half.y}).value();
        BodyDefinition light{.kind = BodyKind::dynamic_body, .shape = shape};
        const double mass = scaled(0.02, 50);
        light.mass.mass = mass;
        light.position = {between(-0.1, 0.1), half.y, between(-0.1, 0.1)};
        body = world->create_body(light).value();
        height = half.y;
        const double density = scaled(0.1, 50);  // kg/m²
        ratio = density / mass;
        auto sheet = cloth_rectangle(1, 1, 0.05, {.area_density = density, .rayleigh_damping = 0.01});
        sheet.pose.position = {0, 2 * half.y + 0.01 + between(0, 0.8), 0};
        EXPECT_TRUE(world->create_deformable(sheet).ok());
    }
};

TEST(LightBodies, UnderHeavySheetsGainNoEnergy) {
    double largest_ratio = 0;
    for (unsigned seed = 0; seed < 30; ++seed) {
        const Covered scene(seed);
        largest_ratio = std::max(largest_ratio, scene.ratio);
        const double start = energy(*scene.world);
        for (int i = 0; i < 150; ++i) {
            scene.world->step();
            ASSERT_LT(energy(*scene.world), 1.01 * start) << seed << " " << i;
            ASSERT_GT(scene.world->pose(scene.body).position.y, 0) << seed << " " << i;
        }
        EXPECT_LT(length(scene.world->linear_velocity(scene.body)), 0.5) << seed;
    }
    EXPECT_GT(largest_ratio, 200);
}

// What presses on it for a moment is no longer there when it leaves.
TEST(LightBodies, ABallUnderALightClothStillBounces) {
    const auto speed_after = [](bool is_covered) {
        const auto world = make_world({});
        const Material bouncing{.restitution = 0.8};
        add_plane(*world, bouncing);
        BodyDefinition ball{.kind = BodyKind::dynamic_body,
                            .shape = world->create_shape(SphereShape{0.1}).value(),
                            .position = {0, 0.4, 0},
                            .material = bouncing};
        ball.mass.mass = 2;
        const BodyHandle body = world->create_body(ball).value();
        if (is_covered) {
            auto sheet = cloth_rectangle(0.4, 0.4, 0.05, {.area_density = 0.05, .rayleigh_damping = 0.01});
            sheet.pose.position = {0, 0.505, 0};
            sheet.attachments = {{static_cast<std::uint32_t>(sheet.nodes.size() / 2), body, {0, 0.1, 0}}};
            EXPECT_TRUE(world->create_deformable(sheet).ok());
        }
        double fastest = 0;
        for (int i = 0; i < 30; ++i) {
            world->step();
            fastest = std::max(fastest, world->linear_velocity(body).y);
        }
        return fastest;
    };
    EXPECT_NEAR(speed_after(true), speed_after(false), 0.1 * speed_after(false));
}

// Folds that meet fast are solved in parts of a step, and what bears the box is in each of them.
TEST(LightBodies, ACoveredBoxIsNotKickedUpByAThrownSheet) {
    Random random(5);
    for (int run = 0; run < 8; ++run) {
        const auto world = make_world({});
        add_plane(*world, {});
        BodyDefinition box{.kind = BodyKind::dynamic_body,
                           .shape = world->create_shape(BoxShape{{0.1, 0.1, 0.1}}).value(),
                           .position = {0, 0.1, 0}};
        box.mass.mass = 50;
        const BodyHandle heavy = world->create_body(box).value();
        auto cover = cloth_rectangle(0.5, 0.5, 0.04, {.area_density = 0.2, .rayleigh_damping = 0.01});
        cover.pose.position = {0, 0.203, 0};
        ASSERT_TRUE(world->create_deformable(cover).ok());
        auto thrown = cloth_rectangle(0.6, 0.6, 0.03, {.area_density = 0.3, .rayleigh_damping = 0.01});
        thrown.pose.position = {0, 1.2, 0};
        const Vec3 axis{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        thrown.pose.rotation = from_axis_angle(normalized(axis), random.between(0.5, 2));
        thrown.linear_velocity = {0, -random.between(10, 30), 0};
        ASSERT_TRUE(world->create_deformable(thrown).ok());
        for (int i = 0; i < 40; ++i) {
            world->step();
            ASSERT_LT(world->linear_velocity(heavy).y, 0.1) << run << " " << i;
            ASSERT_LT(world->pose(heavy).position.y, 0.105) << run << " " << i;
        }
    }
}

// Three sheets one after the other: what bears the box counts once.
TEST(LightBodies, ABoxUnderSheetsThatDoNotTouchEachOtherStays) {
    const auto world = make_world({});
    add_plane(*world, {});
    BodyDefinition box{.kind = BodyKind::dynamic_body,
                       .shape = world->create_shape(BoxShape{{0.5, 0.05, 0.1}}).value(),
                       .position = {0, 0.05, 0}};
    box.mass.mass = 0.05;
    const BodyHandle light = world->create_body(box).value();
    const auto cover = [&](double x, double density) {
        auto sheet = cloth_rectangle(0.2, 0.2, 0.04, {.area_density = density, .rayleigh_damping = 0.01});
        sheet.pose.position = {x, 0.13, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
    };
    cover(-0.3, 50);
    cover(3, 1);  // beside it, on the ground
    cover(0.3, 0.3);
    for (int i = 0; i < 180; ++i) {
        world->step();
        ASSERT_NEAR(world->pose(light).position.y, 0.05, 0.02) << i;
        ASSERT_LT(length(world->linear_velocity(light)), 1) << i;
    }
}

// A plate of 50 g that joints hold in the air bears 5 kg that fall on it.
TEST(LightBodies, APlateOnJointsBearsAHeavySheet) {
    for (const JointKind& kind : {JointKind{FixedJoint{}}, JointKind{HingeJoint{}}}) {
        const auto world = make_world({});
        BodyDefinition plate{.kind = BodyKind::dynamic_body,
                             .shape = world->create_shape(BoxShape{{0.2, 0.01, 0.2}}).value(),
                             .position = {0, 1, 0}};
        plate.mass.mass = 0.05;
        const BodyHandle light = world->create_body(plate).value();
        JointDefinition joint{.joint = kind, .body_b = light};
        joint.frame_a.position = {0, 1, 0};
        ASSERT_TRUE(world->create_joint(joint).ok());
        auto sheet = cloth_rectangle(0.5, 0.5, 0.05, {.area_density = 20, .rayleigh_damping = 0.01});
        sheet.pose.position = {0, 1.2, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
        const double start = energy(*world);
        for (int i = 0; i < 60; ++i) {
            world->step();
            ASSERT_LT(energy(*world), 1.01 * start) << kind.index() << " " << i;
            ASSERT_LT(length(world->pose(light).position - Vec3{0, 1, 0}), 2e-3) << kind.index() << " " << i;
        }
    }
}

// 50 g under 50 kg: what it is pressed with is a thousand times its weight.
TEST(LightBodies, ABoxOnTheGroundStaysThereUnderAHeavySheet) {
    for (const double start_height : {0.1, 0.5}) {
        const auto world = make_world({});
        add_plane(*world, {});
        BodyDefinition box{.kind = BodyKind::dynamic_body,
                           .shape = world->create_shape(BoxShape{{0.1, 0.1, 0.1}}).value(),
                           .position = {0, start_height, 0}};
        box.mass.mass = 0.05;
        const BodyHandle light = world->create_body(box).value();
        auto sheet = cloth_rectangle(1, 1, 0.036, {.area_density = 50, .rayleigh_damping = 0.01});
        sheet.pose.position = {0, 0.5, 0};
        ASSERT_TRUE(world->create_deformable(sheet).ok());
        const double start = energy(*world);
        for (int i = 0; i < 180; ++i) {
            world->step();
            ASSERT_LT(energy(*world), 1.01 * start) << start_height << " " << i;
            ASSERT_GT(world->pose(light).position.y, 0.05) << start_height << " " << i;
        }
    }
}

}  // namespace
}  // namespace embody::physics
