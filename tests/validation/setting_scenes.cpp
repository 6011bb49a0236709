// SPDX-License-Identifier: MIT
#include "validation/setting_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "validation/constraint_scenes.h"
#include "validation/fluid_scenes.h"
#include "validation/setting_scene_parts.h"

namespace embody::physics {
namespace {

// Sleepers that gusts push, a plate that passes close over one, one that is taken away beside another.
void take_one_away(World& world, int step) {
    if (step != 225) return;
    ASSERT_TRUE(world.destroy_body(world.bodies().back()).ok());
}
GoldenScene sleepers() {
    GoldenScene scene = on_plane({.wind = {3, 0, 0}, .gustiness = 0.4, .gust_time = 1}, friction(0.5));
    World& world = *scene.world;
    scene.before_step = take_one_away;
    for (int i = 0; i < 6; ++i) {
        add_box(world, {0.2, 0.2, 0.2},
                {.position = {1.0 * i, 0.2, 0}, .mass = {.mass = 0.2}, .drag_area = 0.03 * (i + 1)});
    }
    add_box(world, {0.5, 0.05, 0.5},
            {.kind = BodyKind::kinematic_body, .position = {-8, 0.4505, 9}, .linear_velocity = {2, 0, 0}});
    for (const Vec3 place : {Vec3{0, 0.2, 9}, Vec3{1.6, 0.2, 5}}) add_box(world, {0.2, 0.2, 0.2}, {.position = place});
    for (int i = 0; i < 3; ++i) add_box(world, {0.2, 0.2, 0.2}, {.position = {0.405 * i, 0.2, 5}});
    return scene;
}

// Thin things that spin at plates and at each other, by less and by more than their thickness in a step.
GoldenScene shots() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    for (int i = 0; i < 12; ++i) {
        const double speed = 1 + 1.5 * i;
        add_box(world, {0.005, 0.4, 0.4}, {.kind = BodyKind::static_body, .position = {2, 0.5, 1.0 * i}});
        add_box(world, {0.15, 0.02, 0.05},
                {.position = {0, 0.6, 1.0 * i},
                 .linear_velocity = {speed, 1, 0},
                 .angular_velocity = {0, 3, 2.0 * i},
                 .continuous = true});
        add_ball(world, 0.04,
                 {.position = {1.9, 0.3, 1.0 * i}, .linear_velocity = {-speed, 2, 0}, .continuous = i % 2 == 0});
        add_ball(world, 0.04,
                 {.position = {-2, 0.3, 1.0 * i}, .linear_velocity = {speed, 2, 0}, .continuous = i % 3 == 0});
    }
    return scene;
}

// Deep in each other at the start, many levels high: what shock propagation takes out.
GoldenScene sunk_wall() {
    GoldenScene scene = on_plane();
    for (int row = 0; row < 14; ++row) {
        for (int i = 0; i < 14; ++i) {
            add_box(*scene.world, {0.5, 0.5, 0.5}, {.position = {i + 0.5 * (row % 2), 0.45 + 0.93 * row, 0}});
        }
    }
    return scene;
}

// Towers of few and heavy on light: which are solved directly.
GoldenScene towers() {
    GoldenScene scene = on_plane();
    for (int tower = 0; tower < 4; ++tower) {
        for (int i = 0; i < 3 + 3 * tower; ++i) {
            add_box(*scene.world, {0.5, 0.5, 0.5},
                    {.position = {3.0 * tower + 0.01 * i, 0.5 + i, 0},
                     .mass = {.mass = tower % 2 == 0 ? 1.0 + 30 * i : 1.0}});
        }
    }
    for (int row = 0; row < 3; ++row) {
        for (int i = 0; i < 7 - row; ++i) {
            add_box(
                *scene.world, {0.24, 0.2, 0.2},
                {.position = {8 + 0.5 * (i + 0.5 * row), 0.2 + 0.4 * row, 5}, .mass = {.mass = row == 2 ? 60.0 : 1.0}});
        }
    }
    for (int i = 0; i < 5; ++i) {
        add_box(*scene.world, {2.0 - 0.1 * i, 0.1, 1}, {.position = {0, 0.1 + 0.2 * i, 5}, .mass = {.mass = 1.0 + i}});
    }
    return scene;
}

// What rolls on planes and on a bowl of triangles, and a coin.
GoldenScene rolling() {
    GoldenScene scene = on_plane({}, {.friction_static = 0.6, .friction_dynamic = 0.5});
    MeshShape bowl;
    constexpr int sides = 24;
    for (int ring = 0; ring <= 6; ++ring) {
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * pi * i / sides, radius = 0.25 * ring + 0.02;
            bowl.positions.push_back(
                to_vec3f({radius * std::cos(angle), 0.25 * radius * radius, radius * std::sin(angle)}));
        }
    }
    const auto at = [](int ring, int i) { return static_cast<std::uint32_t>(ring * sides + i % sides); };
    for (int ring = 0; ring < 6; ++ring) {
        for (int i = 0; i < sides; ++i) {
            bowl.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
            bowl.triangles.push_back({at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
        }
    }
    World& world = *scene.world;
    const auto shape = world.create_shape(bowl);
    EXPECT_TRUE(shape.ok());
    EXPECT_TRUE(world.create_body({.kind = BodyKind::static_body, .shape = shape.value(), .position = {8, 0.1, 0}}));
    for (int i = 0; i < 4; ++i) {
        add_ball(world, 0.1, {.position = {8.3 + 0.25 * i, 0.9, 0.1 * i}, .linear_velocity = {0, 0, 0.4 * i}});
        add_ball(world, 0.2, {.position = {0, 0.2, 1.0 * i}, .linear_velocity = {0.02 + 1.0 * i, 0, 0}});
    }
    const auto add = [&](const ShapeDefinition& form, BodyDefinition like) {
        like.shape = world.create_shape(form).value();
        EXPECT_TRUE(world.create_body(like));
    };
    const Quat on_side = normalized(Quat{1, 0, 0, 1});
    add(CylinderShape{0.3, 0.1}, {.position = {0, 0.3, -2},
                                  .rotation = on_side,
                                  .linear_velocity = {2, 0, 0},
                                  .angular_velocity = {0, 0, -6.7}});
    add(CylinderShape{0.3, 0.02},
        {.position = {0, 0.31, -4}, .rotation = normalized(Quat{0.9, 0, 0.1, 1}), .angular_velocity = {0, 15, 1}});
    add(CylinderShape{0.3, 0.02},
        {.position = {0, 0.304, -6}, .rotation = normalized(Quat{1, 0, 0.05, 1}), .angular_velocity = {0, 2, 0}});
    for (int i = 0; i < 4; ++i) {
        add_ball(world, 0.05, {.position = {4 + 0.1 * i, 0.05, -6}, .linear_velocity = {0.001 * i, 0, 0.01}});
        add_ball(world, 0.05, {.position = {6 + 0.07 * i, 0.05, -6}});
    }
    add(ConeShape{0.3, 0.3}, {.position = {3, 0.4, -4}, .rotation = on_side, .angular_velocity = {2, 3, 0}});
    return scene;
}

// A net of ball joints, too large for one factorisation, that boxes fall on; some of its joints begin a little open.
GoldenScene net() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    constexpr int side = 9;
    std::vector<BodyHandle> knots;
    for (int i = 0; i < side * side; ++i) {
        const int row = i / side, column = i % side;
        const bool is_corner = (row == 0 || row == side - 1) && (column == 0 || column == side - 1);
        knots.push_back(add_ball(world, 0.08,
                                 {.kind = is_corner ? BodyKind::static_body : BodyKind::dynamic_body,
                                  .position = {0.2 * column + (i % 17 == 5 ? 0.05 : 0), 2, 0.2 * row},
                                  .angular_velocity = {0, i % 23 == 7 ? 300.0 : 0, 0}}));
        if (column > 0) join(world, knots[static_cast<std::size_t>(i - 1)], knots.back(), {0.1, 0, 0}, {-0.1, 0, 0});
        if (row > 0) join(world, knots[static_cast<std::size_t>(i - side)], knots.back(), {0, 0, 0.1}, {0, 0, -0.1});
    }
    for (int i = 0; i < 4; ++i) {
        add_box(world, {0.2, 0.2, 0.2}, {.position = {0.8 + 0.2 * i, 2.5 + 0.5 * i, 1}, .mass = {.mass = 20}});
    }
    return scene;
}

// Chains of 5 and of 80 links that fall on the floor and bounce, and a rod that hits a chain that hangs.
GoldenScene falling_chains() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    const Material bouncy{.friction_static = 0.3, .friction_dynamic = 0.3, .restitution = 0.6};
    const auto add_chain = [&](Vec3 at, int links, Vec3 velocity, bool hangs) {
        BodyHandle last;
        for (int i = 0; i < links; ++i) {
            const Vec3 place = at + (hangs ? Vec3{0, -0.2 * i, 0} : Vec3{0.2 * i, 0.002 * i, 0});
            const BodyHandle link = add_box(world, hangs ? Vec3{0.03, 0.09, 0.03} : Vec3{0.09, 0.03, 0.03},
                                            {.position = place, .linear_velocity = velocity, .material = bouncy});
            const Vec3 end = hangs ? Vec3{0, 0.1, 0} : Vec3{-0.1, 0, 0};
            if (i > 0) {
                join(world, last, link, -end, end);
            } else if (hangs) {
                join(world, {}, link, place + end, end);
            }
            last = link;
        }
    };
    add_chain({-8, 0.3, 0}, 80, {0, -2, 0}, false);
    for (int i = 0; i < 3; ++i) add_chain({0, 0.5 + 0.4 * i, 3.0 + i}, 5, {0, -4, 0}, false);
    add_chain({0, 3, 8}, 10, {}, true);
    add_box(world, {0.5, 0.05, 0.05}, {.position = {-2, 2, 8}, .linear_velocity = {12, 0, 0}, .material = bouncy});
    return scene;
}

// Elastic balls: a break, a cradle without gaps, a heap of many that bounce.
GoldenScene elastic_balls() {
    GoldenScene scene = on_plane();
    World& world = *scene.world;
    const Material elastic{.friction_static = 0.1, .friction_dynamic = 0.1, .restitution = 0.95};
    for (int row = 0; row < 6; ++row) {
        for (int i = 0; i <= row; ++i) {
            add_ball(world, 0.05, {.position = {0.0867 * row, 0.05, 0.1 * i - 0.05 * row}, .material = elastic});
        }
    }
    add_ball(world, 0.05, {.position = {-1, 0.05, 0.003}, .linear_velocity = {8, 0, 0}, .material = elastic});
    for (int i = 0; i < 7; ++i) add_ball(world, 0.05, {.position = {3 + 0.1 * i, 1, 0}, .material = elastic});
    add_ball(world, 0.05, {.position = {2.5, 1, 0}, .linear_velocity = {5, 0.4, 0}, .material = elastic});
    for (int i = 0; i < 90; ++i) {
        add_ball(world, 0.05,
                 {.position = {8 + 0.11 * (i % 5), 0.3 + 0.12 * (i / 15), 0.11 * (i / 5 % 3)},
                  .linear_velocity = {0, -3, 0},
                  .material = elastic});
    }
    return scene;
}

SoftSolid foam(double modulus) {
    return {.density = 60, .youngs_modulus = modulus, .poisson_ratio = 0.2, .rayleigh_damping = 0.01};
}

void add_brick(World& world, Vec3 at, const SoftSolid& solid, Vec3 velocity = {}) {
    auto brick = tetrahedral_brick({0.4, 0.3, 0.4}, {4, 3, 4}, solid);
    brick.pose.position = at;
    brick.linear_velocity = velocity;
    brick.material.restitution = 0.4;
    EXPECT_TRUE(world.create_deformable(brick).ok());
}

// Soft bricks on each other, one thrown, one plastic, one full of gas, with bodies on them and one in them.
GoldenScene soft_heap() {
    GoldenScene scene = on_plane({}, {.friction_static = 0.5, .friction_dynamic = 0.4});
    World& world = *scene.world;
    add_brick(world, {0, 0.02, 0}, foam(2e4));
    add_brick(world, {0.1, 0.36, 0.05}, foam(5e3));
    add_brick(world, {-0.9, 0.3, 0.1}, foam(2e4), {4, 1, 0});
    SoftSolid plastic = foam(5e4), airy = foam(1e4);
    plastic.yield_stress = 1500;
    airy.internal_pressure = 2000;
    airy.rayleigh_damping = 0.002;
    add_brick(world, {1, 0.01, 0}, plastic);
    add_brick(world, {2, 0.3, 0}, airy);
    for (int i = 0; i < 3; ++i) {
        add_box(world, {0.12, 0.1, 0.12},
                {.position = {0.2 + i, 0.9 + 0.1 * i, 0.2}, .linear_velocity = {0, -2, 0}, .mass = {.mass = 4}});
    }
    add_ball(world, 0.15, {.position = {2.9, 0.2, 0.2}, .mass = {.mass = 1}});
    add_brick(world, {2.75, 0.1, 0}, foam(2e4));
    return scene;
}

// A sheet over a ball and a box, another over it, one that folds on the floor, a flag in the wind.
GoldenScene sheets() {
    GoldenScene scene = on_plane({.wind = {3, 0, 1}, .gustiness = 0.2}, friction(0.5));
    World& world = *scene.world;
    add_ball(world, 0.25, {.position = {0, 0.25, 0}, .mass = {.mass = 5}});
    add_box(world, {0.1, 0.3, 0.1}, {.position = {0.5, 0.3, 0}, .mass = {.mass = 2}});
    const Cloth cloth{.area_density = 0.2, .rayleigh_damping = 0.005};
    const auto add = [&](double size, Vec3 at, Quat turn, std::vector<std::uint32_t> pinned = {}) {
        auto sheet = cloth_rectangle(size, size, 0.06, cloth);
        sheet.pose = {at, turn};
        sheet.pinned = std::move(pinned);
        EXPECT_TRUE(world.create_deformable(sheet).ok());
    };
    add(1.2, {0.2, 0.62, 0}, {});
    add(0.8, {0.1, 0.7, 0.1}, {});
    add(0.7, {-1.2, 0.4, 0}, normalized(Quat{1, 0, 0.1, 1}));
    add(0.8, {2, 1, 0}, normalized(Quat{0, 0, 1, 1}), {0, 1});
    add_brick(world, {-2.6, 0.01, -0.2}, foam(2e4));
    add(0.7, {-2.4, 0.4, 0}, {});
    return scene;
}

// A rope over a bar with weights, one that falls in a heap, a clamped one that is twisted, one that breaks.
GoldenScene ropes() {
    GoldenScene scene = on_plane({}, friction(0.4));
    World& world = *scene.world;
    const auto bar = world.create_shape(CylinderShape{0.1, 0.5}).value();
    EXPECT_TRUE(world.create_body({.kind = BodyKind::static_body,
                                   .shape = bar,
                                   .position = {0, 1.5, 0},
                                   .rotation = normalized(Quat{1, 0, 0, 1})}));
    const Rope matter{.diameter = 0.02, .linear_density = 0.2, .rayleigh_damping = 0.002};
    auto over = rope_between({-0.8, 1.65, 0}, {0.8, 1.65, 0}, 0.06, matter);
    const auto last = static_cast<std::uint32_t>(over.nodes.size() - 1);
    for (const std::uint32_t end : {0u, last}) {
        const Vec3 node = over.nodes[end];
        const BodyHandle weight = add_box(world, {0.08, 0.08, 0.08},
                                          {.position = node - Vec3{0, 0.08, 0}, .mass = {.mass = end ? 1.0 : 2.0}});
        over.attachments.push_back({end, weight, {0, 0.08, 0}});
    }
    EXPECT_TRUE(world.create_deformable(over).ok());
    EXPECT_TRUE(world.create_deformable(rope_between({1.5, 0.2, 0}, {1.7, 2, 0.1}, 0.06, matter)).ok());

    auto twisted = rope_between({3, 1, 0}, {4, 1, 0}, 0.06, matter);
    const auto end = static_cast<std::uint32_t>(twisted.nodes.size() - 1);
    const BodyHandle holder = add_box(world, {0.1, 0.1, 0.1},
                                      {.kind = BodyKind::kinematic_body,
                                       .position = {4.1, 1, 0},
                                       .linear_velocity = {-0.2, 0, 0},
                                       .angular_velocity = {8, 0, 0}});
    twisted.pinned = {0};
    twisted.attachments = {{end, holder, {-0.1, 0, 0}}};
    twisted.clamps = {{0, {1, 0, 0}}, {end, {1, 0, 0}}};
    EXPECT_TRUE(world.create_deformable(twisted).ok());

    Rope weak = matter;
    weak.break_tension = 30;
    auto breaks = rope_between({-2, 2, 0}, {-2, 1, 0}, 0.06, weak);
    const auto low = static_cast<std::uint32_t>(breaks.nodes.size() - 1);
    breaks.pinned = {0};
    breaks.attachments = {
        {low, add_box(world, {0.1, 0.1, 0.1}, {.position = {-2, 0.9, 0}, .mass = {.mass = 5}}), {0, 0.1, 0}}};
    EXPECT_TRUE(world.create_deformable(breaks).ok());
    return scene;
}

// A column of water breaks onto bodies that float, sink and are grains beside the cells.
GoldenScene dam_break() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_tank(world, {{0, 0, 0}, {0.8, 0.6, 0.3}});
    EXPECT_TRUE(world.create_fluid({.boxes = {{{0, 0, 0}, {0.3, 0.4, 0.3}}}, .cell_size = 0.03}).ok());
    add_box(world, {0.05, 0.05, 0.05}, {.position = {0.55, 0.05, 0.15}, .mass = {.mass = 0.5}});
    add_box(world, {0.05, 0.05, 0.05}, {.position = {0.7, 0.05, 0.1}, .mass = {.mass = 3}});
    add_ball(world, 0.006, {.position = {0.45, 0.01, 0.15}, .mass = {.mass = 5e-4}});
    add_ball(world, 0.03, {.position = {0.15, 0.5, 0.15}, .linear_velocity = {0, -3, 0}, .mass = {.mass = 0.05}});
    return scene;
}

// Thick liquid that flows from a step, a drop that wets, paste that stands.
GoldenScene thick_liquids() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_tank(world, {{0, 0, 0}, {0.4, 0.4, 0.2}}, 0.1);
    add_box(world, {0.08, 0.05, 0.1}, {.kind = BodyKind::static_body, .position = {0.08, 0.05, 0.1}});
    EXPECT_TRUE(
        world
            .create_fluid(
                {.boxes = {{{0, 0.1, 0}, {0.16, 0.25, 0.2}}}, .density = 1400, .viscosity = 5, .cell_size = 0.02})
            .ok());
    EXPECT_TRUE(world
                    .create_fluid({.boxes = {{{0.28, 0, 0.04}, {0.38, 0.12, 0.16}}},
                                   .viscosity = 1,
                                   .yield_stress = 100,
                                   .cell_size = 0.02})
                    .ok());
    return scene;
}
GoldenScene drops() {
    GoldenScene scene = on_plane();
    EXPECT_TRUE(scene.world
                    ->create_fluid({.boxes = {{{-0.006, 0.002, -0.006}, {0.006, 0.012, 0.006}}},
                                    .surface_tension = 0.072,
                                    .cell_size = 0.0015})
                    .ok());
    return scene;
}

// A little water in a trough, until it rests; then a box is put into it.
void put_box_in(World& world, int step) {
    if (step != 300) return;
    add_box(world, {0.04, 0.04, 0.04}, {.position = {0.1, 0.1, 0.1}, .mass = {.mass = 0.3}});
}
GoldenScene resting_water() {
    GoldenScene scene{make_world()};
    scene.before_step = put_box_in;
    add_tank(*scene.world, {{0, 0, 0}, {0.2, 0.3, 0.2}}, 0.1);
    add_box(*scene.world, {0.03, 0.03, 0.03}, {.position = {0.1, 0.09, 0.1}, .mass = {.mass = 0.1}});
    EXPECT_TRUE(
        scene.world->create_fluid({.boxes = {{{0, 0, 0}, {0.2, 0.08, 0.2}}}, .viscosity = 0.1, .cell_size = 0.025})
            .ok());
    return scene;
}

HullShape box_hull(Vec3 half) {
    HullShape hull;
    for (int corner = 0; corner < 8; ++corner) {
        hull.points.push_back(
            {corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z});
    }
    return hull;
}

// Water around a paddle of pieces with cracks between, that spins beside a thin sheet of triangles and is put
// elsewhere; drops of it have been thrown far.
void put_paddle(World& world, int step) {
    if (step != 40) return;
    ASSERT_TRUE(world.set_pose(world.bodies().back(), {{0.35, 0.15, 0.15}, {}}));
}
GoldenScene stirred_water() {
    GoldenScene scene{make_world()};
    scene.before_step = put_paddle;
    World& world = *scene.world;
    add_tank(world, {{0, 0, 0}, {0.6, 0.4, 0.3}}, 0.1);
    const MeshShape sheet{{{0.3F, 0, 0}, {0.3F, 0.3F, 0}, {0.3F, 0.3F, 0.3F}, {0.3F, 0, 0.3F}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto wall = world.create_shape(sheet).value();
    EXPECT_TRUE(world.create_body({.kind = BodyKind::static_body, .shape = wall}));
    FluidDefinition water{.boxes = {{{0, 0, 0}, {0.6, 0.2, 0.3}}}, .cell_size = 0.025};
    for (int i = 0; i < 40; ++i) water.points.push_back({2.0 + 0.25 * i, 1 + 0.2 * (i % 7), 3.0 + 0.3 * (i % 11)});
    EXPECT_TRUE(world.create_fluid(water).ok());
    CompoundShape paddle;
    for (const double side : {-1, 1})
        paddle.children.push_back({box_hull({0.05, 0.06, 0.02}), {{side * 0.0504, 0, 0}, {}}});
    const auto pieces = world.create_shape(paddle).value();
    EXPECT_TRUE(world.create_body({.kind = BodyKind::kinematic_body,
                                   .shape = pieces,
                                   .position = {0.15, 0.12, 0.15},
                                   .linear_velocity = {0.3, 0, 0},
                                   .angular_velocity = {0, 25, 6}}));
    return scene;
}

constexpr SettingScene scenes[] = {
    {"collision", "shots", shots},
    {"optimization", "sleepers", sleepers, 240},
    {"optimization", "sunk_wall", sunk_wall, 60},
    {"optimization", "towers", towers},
    {"constraint", "rolling", rolling, 180},
    {"constraint", "rolling_bodies", rolling_bodies, 60},
    {"constraint", "balls_in_bowls", balls_in_bowls},
    {"constraint", "small_pyramids", small_pyramids, 30},
    {"constraint", "long_chain", long_chain, 20},
    {"constraint", "loaded_chain", loaded_chain, 140},
    {"constraint", "many_bounces", many_bounces, 5},
    {"constraint", "net", net, 20},
    {"constraint", "falling_chains", falling_chains, 40},
    {"constraint", "elastic_balls", elastic_balls},
    {"deformable", "soft_heap", soft_heap, 90},
    {"deformable", "sheets", sheets, 60},
    {"deformable", "ropes", ropes},
    {"fluid", "dam_break", dam_break, 60},
    {"fluid", "thick_liquids", thick_liquids, 40},
    {"fluid", "drops", drops, 30},
    {"fluid", "stirred_water", stirred_water, 60},
    {"fluid", "resting_water", resting_water, 360},
};

}  // namespace

std::span<const SettingScene> setting_scenes() { return scenes; }

}  // namespace embody::physics
