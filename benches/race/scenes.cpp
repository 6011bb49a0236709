// SPDX-License-Identifier: MIT
//
// Table I (e), (f), (g) of the paper and structures on which engines differ. The numbers and the order of the random
// draws are part of the scenes, so that figures of other days and other machines are comparable.
#include "benches/race/scenes.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace embody::race {
namespace {

constexpr double density = 1000;  // kg/m³
constexpr int to_the_end = std::numeric_limits<int>::max();
constexpr double two_pi = 2 * std::numbers::pi;

/// Uniform over all rotations: Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
Quat random_rotation(SceneRandom& random) {
    const double a = random.unit(), b = random.unit() * two_pi, c = random.unit() * two_pi;
    const double p = std::sqrt(1 - a), q = std::sqrt(a);
    return {p * std::sin(b), p * std::cos(b), q * std::sin(c), q * std::cos(c)};
}

void add_body(RaceScene& scene, std::size_t shape, Vec3 position, Quat rotation = {}) {
    scene.bodies.push_back(
        {.shape = shape, .position = position, .rotation = rotation, .mass = density * scene.shapes[shape].volume});
}

void add_ground(RaceScene& scene) { scene.statics.push_back({{100, 1, 100}, {0, -1, 0}}); }

RaceShape unit_cube() { return make_box({0.5, 0.5, 0.5}); }

/// Four walls of 1 m about a square.
void add_pen(RaceScene& scene, double half_width, double height) {
    scene.pen_half_width = half_width;
    scene.pen_height = height;
    constexpr double half_wall = 0.5;
    const double at = half_width + half_wall, along = half_width + 2 * half_wall;
    for (const double side : {-1.0, 1.0})
        scene.statics.push_back({{half_wall, height / 2, along}, {side * at, height / 2, 0}});
    for (const double side : {-1.0, 1.0})
        scene.statics.push_back({{along, height / 2, half_wall}, {0, height / 2, side * at}});
}

/// Unit cubes in one plane, `base` in the lowest row, each on two cubes of the row below.
void add_pyramid(RaceScene& scene, int base) {
    scene.shapes.push_back(unit_cube());
    for (int row = 0; row < base; ++row)
        for (int j = row; j < base; ++j) add_body(scene, 0, {0.5 * row + (j - row) - 0.5 * (base - 1), 0.5 + row, 0});
    scene.true_top = base - 0.5;
}

/// A column of unit cubes.
void add_column(RaceScene& scene, int count) {
    scene.shapes.push_back(unit_cube());
    for (int i = 0; i < count; ++i) add_body(scene, 0, {0, 0.5 + i, 0});
    scene.true_top = count - 0.5;
    scene.stands_until = to_the_end;
}

void build_table1_e(RaceScene& scene) {
    scene.what = "pyramid of 55 cubes, hit by a 10 t sphere";
    add_ground(scene);
    add_pyramid(scene, 10);
    scene.shapes.push_back(make_sphere(0.5));
    scene.stands_until = 120;
    scene.events.push_back(
        {.frame = 120,
         .spawned = RaceBody{.shape = 1, .position = {0, 3.5, -6}, .mass = 10 * density, .velocity = {0, 0, 20}}});
}

void build_table1_f(RaceScene& scene) {
    scene.what = "wall of 21 x 10 cubes, three at the bottom pushed out";
    add_ground(scene);
    scene.shapes.push_back(unit_cube());
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 21; ++column)
            add_body(scene, 0, {column - 10 + (row % 2 == 1 ? 0.5 : 0.0), 0.5 + row, 0});
    scene.true_top = 9.5;
    scene.stands_until = 120;
    for (const std::size_t pushed : {9u, 10u, 11u})
        scene.events.push_back({.frame = 120, .spawned = {}, .body = pushed, .velocity = {0, 0, 10}});
}

void build_table1_g(RaceScene& scene) {
    scene.what = "343 spheres, boxes and cylinders into a pen";
    add_ground(scene);
    add_pen(scene, 6, 6);
    scene.shapes = {make_sphere(0.25), make_box({0.25, 0.25, 0.25}), make_cylinder(0.25, 0.25)};
    SceneRandom random;
    std::size_t next = 0;
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 7; ++x) {
            for (int z = 0; z < 7; ++z) {
                const double off_x = random.between(-.05, .05), off_z = random.between(-.05, .05);
                add_body(scene, next++ % 3, {x - 3 + off_x, 5.25 + y, z - 3 + off_z}, random_rotation(random));
            }
        }
    }
}

void build_big_pyramid(RaceScene& scene) {
    scene.what = "pyramid of 1830 cubes, 60 in the lowest row";
    add_ground(scene);
    add_pyramid(scene, 60);
    scene.stands_until = to_the_end;
}

void build_pile_5k(RaceScene& scene) {
    scene.what = "5000 spheres, boxes and hulls of 16 vertices into a pen";
    add_ground(scene);
    add_pen(scene, 7, 20);
    SceneRandom random;
    scene.shapes = {make_sphere(0.25), make_box({0.25, 0.25, 0.25})};
    for (int i = 0; i < 8; ++i) scene.shapes.push_back(make_hull(random, 16, 0.3));

    // Layers of 17 x 17 above each other.
    for (int k = 0; k < 5000; ++k) {
        const int layer = k / 289, place = k % 289;
        const double off_x = random.between(-.04, .04), off_z = random.between(-.04, .04);
        const int row = place / 17, column = place % 17;
        const Vec3 position{(column - 8) * 0.8 + off_x, 0.6 + 0.8 * layer, (row - 8) * 0.8 + off_z};
        const int shape = k % 3 == 2 ? 2 + (k / 3) % 8 : k % 3;
        add_body(scene, static_cast<std::size_t>(shape), position, random_rotation(random));
    }
}

double terrain_height(double x, double z) {
    return 1.5 * std::sin(two_pi * x / 41.0) * std::cos(two_pi * z / 37.0) +
           1.0 * std::sin(two_pi * (x + 0.6 * z) / 17.0) + 0.5 * std::cos(two_pi * (z - 0.4 * x) / 9.0);
}

Terrain make_terrain(int cells) {
    Terrain terrain{.cells = cells};
    const int row = cells + 1;
    for (int z = 0; z < row; ++z)
        for (int x = 0; x < row; ++x)
            terrain.vertices.push_back(
                {x - 0.5 * cells, terrain_height(x - 0.5 * cells, z - 0.5 * cells), z - 0.5 * cells});
    for (int z = 0; z < cells; ++z) {
        for (int x = 0; x < cells; ++x) {
            const int a = z * row + x, b = a + 1, c = a + row, d = c + 1;
            terrain.indices.insert(terrain.indices.end(), {a, c, b, b, c, d});
        }
    }
    return terrain;
}

void build_mesh_1k(RaceScene& scene) {
    scene.what = "1000 hulls of 16 to 32 vertices on 115200 triangles";
    scene.terrain = make_terrain(240);
    SceneRandom random;
    for (int i = 0; i < 17; ++i) scene.shapes.push_back(make_hull(random, 16 + i, 0.5));
    for (int k = 0; k < 1000; ++k) {
        const int layer = k / 256, place = k % 256;
        const double off_x = random.between(-.5, .5), off_z = random.between(-.5, .5);
        const int row = place / 16, column = place % 16;
        const Vec3 position{(column - 7.5) * 3 + off_x, 6.0 + 2.0 * layer, (row - 7.5) * 3 + off_z};
        add_body(scene, static_cast<std::size_t>(k % 17), position, random_rotation(random));
    }
}

void build_tall_stack(RaceScene& scene) {
    scene.what = "column of 30 cubes, 20 s";
    scene.steps = 1200;
    add_ground(scene);
    add_column(scene, 30);
}

void build_hi_restitution(RaceScene& scene) {
    scene.what = "10 cubes above each other with gaps, e = 0.8";
    scene.restitution = 0.8;
    add_ground(scene);
    add_column(scene, 10);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        scene.bodies[i].position.y = 1.0 + 1.5 * static_cast<double>(i);
    // The cubes fall by half a metre each: where they come to rest is shown, not judged.
    scene.stands_until.reset();
}

/// A column in which each cube is `factor` times as heavy as the one below, 1 kg at the bottom.
void build_mass_ratio(RaceScene& scene, int count, double factor) {
    add_ground(scene);
    add_column(scene, count);
    double mass = 1;
    for (RaceBody& body : scene.bodies) {
        body.mass = mass;
        mass *= factor;
    }
}
void build_mass_ratio_2(RaceScene& scene) {
    scene.what = "1000 kg on 1 kg";
    build_mass_ratio(scene, 2, 1000);
}
void build_mass_ratio_5(RaceScene& scene) {
    scene.what = "1, 10, 100, 1000, 10000 kg upwards";
    build_mass_ratio(scene, 5, 10);
}

constexpr std::array<std::string_view, 10> names{"table1_e",     "table1_f",    "table1_g",   "big_pyramid",
                                                 "pile_5k",      "mesh_1k",     "tall_stack", "hi_restitution",
                                                 "mass_ratio_2", "mass_ratio_5"};
constexpr std::array builders{build_table1_e,     build_table1_f,    build_table1_g,   build_big_pyramid,
                              build_pile_5k,      build_mesh_1k,     build_tall_stack, build_hi_restitution,
                              build_mass_ratio_2, build_mass_ratio_5};
static_assert(names.size() == builders.size());

}  // namespace

std::span<const std::string_view> race_scene_names() { return names; }

std::optional<RaceScene> make_race_scene(std::string_view name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] != name) continue;
        RaceScene scene{.name = std::string(name)};
        builders[i](scene);
        return scene;
    }
    return std::nullopt;
}

}  // namespace embody::race
