// SPDX-License-Identifier: MIT
// Scenes of what solids, sheets, ropes and liquids seldom come to.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "validation/fluid_scenes.h"
#include "validation/reference.h"
#include "validation/setting_scene_parts.h"
#include "validation/setting_scenes.h"

namespace embody::physics {
namespace {

constexpr BodyKind still = BodyKind::static_body, led = BodyKind::kinematic_body;

DeformableHandle add(World& world, DeformableDefinition definition, Vec3 at, Vec3 velocity = {}, Vec3 spin = {}) {
    definition.pose.position = at;
    definition.linear_velocity = velocity;
    definition.angular_velocity = spin;
    return world.create_deformable(definition).value();
}

DeformableDefinition brick(Vec3 size, std::array<int, 3> cells, double modulus) {
    return tetrahedral_brick(
        size, cells, {.density = 200, .youngs_modulus = modulus, .poisson_ratio = 0.2, .rayleigh_damping = 0.02});
}

const Cloth linen{.area_density = 0.2, .rayleigh_damping = 0.005, .bend_friction = 40};
const Rope cord{.diameter = 0.02, .linear_density = 0.2, .rayleigh_damping = 0.002};

// Without weight: bricks that begin within each other and in bodies, and one that spins fast.
GoldenScene bricks_within_others() {
    GoldenScene scene{make_world({.gravity = {}})};
    World& world = *scene.world;
    for (const double beside : {0.0, 0.16}) {
        add(world, brick({0.2, 0.2, 0.2}, {4, 4, 4}, 1e5), {beside, 0, 0});
        add(world, brick({0.2, 0.2, 0.2}, {4, 4, 4}, 1e5), {beside + 0.03, 0.16, 0.5 * beside});
    }
    add_box(world, {0.06, 0.06, 0.06}, {.kind = still, .position = {2, 0, 0}});
    add(world, brick({0.1, 0.1, 0.1}, {3, 3, 3}, 1e5), {1.955, -0.045, -0.055});
    add(world, brick({0.1, 0.1, 0.1}, {2, 2, 2}, 1e6), {4, 0, 0}, {}, {0, 0, 200});
    return scene;
}

// A box on a blanket on a mattress, one on a sheet on the floor; a rope that falls over a sheet.
GoldenScene loaded_sheets() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_plane(world, friction(0.5));
    add(world, brick({0.4, 0.2, 0.4}, {4, 2, 4}, 2e4), {-0.2, 0.005, -0.2});
    add(world, cloth_rectangle(0.5, 0.5, 0.08, linen), {0, 0.208, 0});
    add_box(world, {0.1, 0.1, 0.1}, {.position = {0, 0.312, 0}, .mass = {.mass = 3}});
    add(world, cloth_rectangle(0.5, 0.5, 0.08, linen), {2, 0.002, 0});
    add_box(world, {0.1, 0.1, 0.1}, {.position = {2, 0.105, 0}, .mass = {.mass = 20}});
    add_box(world, {0.2, 0.1, 0.2}, {.kind = still, .position = {4, 0.1, 0}});
    add(world, cloth_rectangle(0.5, 0.5, 0.08, linen), {4, 0.203, 0});
    Cloth foil{.area_density = 0.3, .stretch_stiffness = 5000, .shear_stiffness = 2000, .internal_pressure = 3000};
    add(world, cloth_ball(0.1, 0.05, foil), {6, 0.3, 0});
    add(world, rope_between({3.6, 0.23, 0.05}, {4.4, 0.24, -0.05}, 0.06, cord), {}, {0, -1, 0});
    return scene;
}

// A thick sheet falls over a small ball, another over the edge of a box.
GoldenScene thick_sheets() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    auto felt = cloth_rectangle(0.3, 0.3, 0.03, linen);
    felt.contact_radius = 0.02;
    add_ball(world, 0.08, {.kind = still, .position = {0, 0, 0}});
    add(world, felt, {0.01, 0.11, 0}, {0, -1, 0});
    add_box(world, {0.1, 0.05, 0.1}, {.kind = still, .position = {1, 0, 0}});
    add(world, felt, {1.1, 0.08, 0.03}, {0, -1, 0});
    return scene;
}

// Sheets thrown at posts, around which they slap together.
GoldenScene slapping_sheets() {
    GoldenScene scene{make_world({.gravity = {}})};
    World& world = *scene.world;
    for (int i = 0; i < 2; ++i) {
        add_ball(world, 0.03, {.kind = still, .position = {0.1, 0, 2.0 * i}});
        auto sheet = cloth_rectangle(0.4, 0.4, 0.04, linen);
        sheet.pose.rotation = normalized(Quat{0, 0, 1, 1});
        add(world, sheet, {0, 0, 2.0 * i}, {20.0 + 20 * i, 0, 0});
    }
    add(world, cloth_rectangle(0.4, 0.4, 0.05, linen), {5, 0, 0}, {}, {40, 30, 20});
    add_ball(world, 0.03, {.kind = still, .position = {0.1, 0, 4}});
    auto felt = cloth_rectangle(0.4, 0.4, 0.04, linen);
    felt.contact_radius = 0.01;
    felt.pose.rotation = normalized(Quat{0, 0, 1, 1});
    add(world, felt, {0, 0, 4}, {20, 0, 0});
    add_box(world, {0.05, 0.3, 0.3}, {.kind = still, .position = {8.1, 0, 0}});
    for (const double speed : {5.0, 40.0}) {
        auto sheet = cloth_rectangle(0.4, 0.4, 0.04, linen);
        sheet.pose.rotation = normalized(Quat{0, 0, 1, 1});
        add(world, sheet, {8.04 - speed / 400, 0, 0}, {speed, 0, 0});
    }
    return scene;
}

// A sheet thrown at one that lies on the floor and over a ball: nodes on a body are held by the guard.
GoldenScene thrown_sheet() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_plane(world, {});
    add_ball(world, 0.05, {.kind = still, .position = {0, 0.05, 0}});
    add(world, cloth_rectangle(0.4, 0.4, 0.05, {.area_density = 0.2}), {0, 0.002, 0});
    add(world, cloth_rectangle(0.3, 0.3, 0.04, {.area_density = 0.2}), {0.02, 0.05, 0.01}, {0, -20, 0});
    return scene;
}

// A plate comes down on a sheet and on one with two layers until both have less room than they need.
GoldenScene pressed_sheets() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_plane(world, friction(0.5));
    auto flat = cloth_rectangle(0.2, 0.2, 0.04, linen), folded = cloth_rectangle(0.2, 0.4, 0.04, linen);
    flat.contact_radius = folded.contact_radius = 0.005;
    for (Vec3& node : folded.nodes) {
        if (node.z > 0.01) node = {node.x, 0.02, -node.z};
    }
    add(world, flat, {-0.2, 0.006, 0});
    add(world, folded, {0.2, 0.006, 0});
    add_box(world, {0.5, 0.1, 0.5}, {.kind = led, .position = {0, 0.13, 0}, .linear_velocity = {0, -0.12, 0}});
    return scene;
}

// Heavy ropes that begin in light boxes and in the floor.
GoldenScene heavy_ropes() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    add_plane(world, friction(0.5));
    for (int i = 0; i < 4; ++i) {
        add_box(world, {0.05, 0.05, 0.05}, {.position = {1.0 * i, 0.3, 0}, .mass = {.mass = 0.05}});
        auto cable = rope_between({0, -0.2 + 0.05 * i, 0}, {0.05 * i, 0.4, 0}, 0.04,
                                  {.linear_density = 83, .axial_stiffness = 1e5, .rayleigh_damping = 0.01});
        cable.contact_radius = 0.01;
        add(world, cable, {1.0 * i, 0, 0});
    }
    return scene;
}

// A brick asleep, past which plates are led.
void lead_plates(World& world, int step) {
    if (step < 150 || step % 30 > 0) return;
    add_box(world, {0.02, 0.02, 0.02},
            {.kind = led, .position = {-0.125, 0.05, 0}, .linear_velocity = {0, 0, 1e-3 * (step - 100)}});
}
GoldenScene sleeping_brick() {
    GoldenScene scene{make_world({.time_to_sleep = 0.1})};
    scene.before_step = lead_plates;
    add_plane(*scene.world, friction(0.5));
    add(*scene.world, brick({0.2, 0.1, 0.2}, {2, 1, 2}, 1e5), {-0.1, 0.001, -0.1});
    return scene;
}

// Thick liquid that comes to rest in a trough, honey that still runs.
GoldenScene liquids_that_settle() {
    GoldenScene scene{make_world({.time_step = 0.05})};
    World& world = *scene.world;
    add_tank(world, {{0, 0, 0}, {0.2, 0.3, 0.2}}, 0.1);
    EXPECT_TRUE(world.create_fluid({.boxes = {{{0, 0, 0}, {0.1, 0.1, 0.2}}}, .viscosity = 20, .cell_size = 0.025}));
    add_box(world, {0.2, 0.1, 0.2}, {.kind = still, .position = {2, -0.1, 0}});
    EXPECT_TRUE(world.create_fluid(
        {.boxes = {{{1.98, 0, -0.02}, {2.02, 0.05, 0.02}}}, .density = 1420, .viscosity = 100, .cell_size = 0.01}));
    return scene;
}

// Without weight: water around one side of a ball, drops of it at the other.
GoldenScene water_on_a_ball() {
    GoldenScene scene{make_world({.gravity = {}})};
    World& world = *scene.world;
    add_ball(world, 0.1, {.linear_velocity = {0.05, 0, 0}, .mass = {.mass = 2}});
    FluidDefinition water{.boxes = {{{-0.16, -0.08, -0.08}, {-0.04, 0.08, 0.08}}},
                          .velocity = {0.2, 0.1, 0},
                          .surface_tension = 0.072,
                          .cell_size = 0.02};
    for (int i = 0; i < 24; ++i) {
        const double away = 0.101 + 0.0018 * i, angle = -1 + 0.08 * i;
        water.points.push_back({away * std::cos(angle), away * std::sin(angle), 0.01 * (i % 3)});
    }
    EXPECT_TRUE(world.create_fluid(water));
    return scene;
}

// Water falls on a light sheet whose corners are held.
GoldenScene water_on_a_sheet() {
    GoldenScene scene{make_world()};
    World& world = *scene.world;
    auto sheet = cloth_rectangle(0.3, 0.3, 0.05, linen);
    for (std::uint32_t i = 0; i < sheet.nodes.size(); ++i) {
        if (std::fabs(sheet.nodes[i].x * sheet.nodes[i].z) > 0.02) sheet.pinned.push_back(i);
    }
    add(world, sheet, {});
    EXPECT_TRUE(world.create_fluid(
        {.boxes = {{{-0.08, 0.02, -0.08}, {0.08, 0.1, 0.08}}}, .velocity = {0, -2, 0}, .cell_size = 0.03}));
    return scene;
}

// As much water that its particles count for the box of its cells, and drops so far that they may be too far.
GoldenScene far_drops() {
    GoldenScene scene{make_world()};
    FluidDefinition water{.boxes = {{{0, 0, 0}, {0.32, 0.32, 0.32}}}, .cell_size = 0.02};
    for (int i = 0; i < 40; ++i) water.points.push_back({2 + 0.02 * i, 2 + 0.02 * i, 2 + 0.02 * i});
    EXPECT_TRUE(scene.world->create_fluid(water));
    return scene;
}

constexpr SettingScene scenes[] = {
    {"deformable", "bricks_within_others", bricks_within_others, 30},
    {"deformable", "loaded_sheets", loaded_sheets, 20},
    {"deformable", "thick_sheets", thick_sheets, 15},
    {"deformable", "slapping_sheets", slapping_sheets, 12},
    {"deformable", "thrown_sheet", thrown_sheet, 20},
    {"deformable", "pressed_sheets", pressed_sheets, 15},
    {"deformable", "heavy_ropes", heavy_ropes, 20},
    {"deformable", "sleeping_brick", sleeping_brick, 360},
    {"fluid", "liquids_that_settle", liquids_that_settle, 70},
    {"fluid", "water_on_a_ball", water_on_a_ball, 10},
    {"fluid", "water_on_a_sheet", water_on_a_sheet, 12},
    {"fluid", "far_drops", far_drops, 2},
};

}  // namespace

std::span<const SettingScene> matter_setting_scenes() { return scenes; }

}  // namespace embody::physics
