// SPDX-License-Identifier: MIT
#include "validation/constraint_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "validation/setting_scene_parts.h"

namespace embody::physics {
namespace {

// A bowl of the height rise · r² (rise in 1/m), its lowest place there: 16 × 16 cells of 0.1 m.
void add_bowl(World& world, Vec3 lowest, double rise, const Material& material) {
    constexpr int rows = 17;
    constexpr double cell = 0.1, half = cell * (rows / 2);
    HeightfieldShape shape{rows, rows, cell, cell, {}};
    for (int i = 0; i < rows * rows; ++i) {
        const double x = cell * (i % rows) - half, z = cell * (i / rows) - half;
        shape.heights.push_back(static_cast<float>(rise * (x * x + z * z)));
    }
    add_shape(world, shape,
              {.kind = BodyKind::static_body, .position = lowest - Vec3{half, 0, half}, .material = material});
}

}  // namespace

GoldenScene rolling_bodies() {
    GoldenScene scene = on_plane({}, friction(0.6));
    World& world = *scene.world;
    CompoundShape wheels;
    for (const double side : {-1, 1}) wheels.children.push_back({CylinderShape{0.05, 0.02}, {{0, 0.08 * side, 0}, {}}});
    const ShapeDefinition forms[] = {CylinderShape{0.05, 0.1}, wheels};
    for (int i = 0; i < 2; ++i) {
        add_shape(world, forms[i],
                  {.position = {0, 0.05, 5.0 * i},
                   .rotation = from_axis_angle({1, 0, 0}, pi / 2 + (i == 0 ? 1e-4 : 0)),
                   .linear_velocity = {3, 0, 0},
                   .angular_velocity = {0, 0, -60},
                   .material = friction(0.6)});
    }
    constexpr double radius = 0.05, half_height = 0.002, lean = 0.1, speed = 2;
    const Vec3 axis{std::sin(lean), std::cos(lean), 0}, down{std::cos(lean), -std::sin(lean), 0};
    const Vec3 arm = down * radius - axis * half_height;
    add_shape(world, CylinderShape{radius, half_height},
              {.position = {0, -arm.y, -3},
               .rotation = from_two_vectors({0, 1, 0}, axis),
               .angular_velocity = arm * (speed / length(arm)),
               .material = friction(0.6)});
    return scene;
}

GoldenScene balls_in_bowls() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    constexpr double rise = 0.5, radius = 0.1;  // 1/m, m
    for (int i = 0; i < 5; ++i) add_bowl(world, {4.0 * i, 0, 0}, rise, friction(0.5));
    // At x, that far above the smooth bowl, m; the speeds are along the bowl towards +X, away from it and
    // around it, m/s.
    const auto add = [&](int bowl, double x, double above, Vec3 speeds) {
        const Vec3 normal = normalized(Vec3{-2 * rise * x, 1, 0}), along{normal.y, -normal.x, 0};
        add_ball(world, radius,
                 {.position = Vec3{4.0 * bowl + x, rise * x * x, 0} + normal * (radius + above),
                  .linear_velocity = along * speeds.x + normal * speeds.y + Vec3{0, 0, speeds.z},
                  .material = friction(0.5)});
    };
    add(0, -0.095, 0, {0.5, 0, 0});
    add(0, 0.095, 0, {-0.5, 0, 0});
    add(1, 0.02, 0, {});
    add(2, 0.2, 1e-4, {0.5, -0.03, 0});
    add(3, 0.4, 0, {0, 0, 0.5});
    add(4, 0, 2.5e-4, {});
    return scene;
}

GoldenScene small_pyramids() {
    GoldenScene scene = on_plane();
    for (int pyramid = 0; pyramid < 12; ++pyramid) {
        for (int row = 0; row < 3; ++row) {
            for (int i = 0; i < 3 - row; ++i) {
                add_shape(*scene.world, BoxShape{{0.2, 0.2, 0.2}},
                          {.position = {0.45 * (i + 0.5 * row), 0.2 + 0.4 * row, 1.0 * pyramid}});
            }
        }
    }
    return scene;
}

GoldenScene long_chain() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    const Vec3 end{0.1, 0, 0};
    BodyHandle last;
    for (int i = 0; i < 260; ++i) {
        const Vec3 place{2 * end.x * i, 8, 0};
        const BodyHandle link =
            add_ball(world, 0.05, {.position = place, .angular_velocity = {0, 0, i % 20 == 10 ? 300.0 : 0}});
        join(world, last, link, i == 0 ? place - end : end, -end);
        last = link;
    }
    const BodyHandle rotor = add_ball(world, 0.1, {.position = {0, 2, 2}, .angular_velocity = {300, 0, 0}});
    EXPECT_TRUE(world.create_joint(
        {.joint = HingeJoint{.limit = JointLimit{-1, 1}}, .body_b = rotor, .frame_a = {{0, 2, 2}, {}}}));
    return scene;
}

GoldenScene many_bounces() {
    GoldenScene scene = on_plane();
    constexpr double radius = 0.05, height = 3.9 * radius;  // m; reached in the second step
    for (int i = 0; i < 27 * 27; ++i) {
        const Vec3 place{4 * radius * (i % 27), radius, 4 * radius * (i / 27)};
        add_ball(*scene.world, radius, {.position = place});
        add_ball(*scene.world, radius,
                 {.position = {place.x, height, place.z},
                  .linear_velocity = {0, -1.7, 0},
                  .material = {.restitution = 0.8}});
    }
    return scene;
}

GoldenScene loaded_chain() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    constexpr int count = 8;
    constexpr double height = 1.4, half = 1.0 / count;
    BodyHandle last;
    const auto hang = [&](double mass, double x, double arm, const ShapeDefinition& shape) {
        const BodyHandle link =
            add_shape(world, shape, {.position = {x, height, 0}, .mass = {.mass = mass}, .allow_sleep = false});
        join(world, last, link, last.is_null() ? Vec3{0, height, 0} : Vec3{half, 0, 0}, {-arm, 0, 0});
        last = link;
    };
    for (int i = 0; i < count; ++i) hang(0.1, half * (2 * i + 1), half, BoxShape{Vec3{0.45, 0.1, 0.1} * (2 * half)});
    hang(1000, 2.2, 0.2, SphereShape{0.2});
    return scene;
}

}  // namespace embody::physics
