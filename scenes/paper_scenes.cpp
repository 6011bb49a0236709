// SPDX-License-Identifier: MIT
#include "scenes/paper_scenes.h"
#include "attributes/physical_kind.h"

#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "scenes/document_parts.h"
#include "scenes/generated_meshes.h"

namespace embody::scenes {
namespace {

using physics::BoxShape;
using physics::CylinderShape;
using physics::SphereShape;

/// Uniformly distributed rotation (Shoemake, "Uniform random rotations", 1992).
Quat random_rotation(Random& random) {
    const double u = random.unit();
    const double a = 2 * std::numbers::pi * random.unit();
    const double b = 2 * std::numbers::pi * random.unit();
    const double s = std::sqrt(1 - u);
    const double t = std::sqrt(u);
    return {s * std::sin(a), s * std::cos(a), t * std::sin(b), t * std::cos(b)};
}

/// A ball that is not there until `time`, and then has this velocity.
void add_shot(DocumentParts& parts, double radius, double mass, Vec3 from, Vec3 velocity, double time) {
    scene::Entity& ball = parts.add("ball", SphereShape{radius}, from, accent_color);
    ball.attributes.erase("density");
    ball.attributes["mass"] = mass;
    ball.enabled = false;
    ball.category = "shot";
    const scene::EntityIndex index = ball.index;
    parts.enable_at(time, index);
    parts.push_at(time, index, velocity);
}

/// `columns` × `rows` cubes of 1 m in running bond in the plane z = center.z.
void add_wall(DocumentParts& parts, int columns, int rows, Vec3 center, Color color) {
    for (int row = 0; row < rows; ++row) {
        for (int i = 0; i < columns; ++i) {
            const double shift = row % 2 == 1 ? 0.5 : 0;
            parts.add("cube", BoxShape{}, center + Vec3{i - (columns - 1) / 2.0 + shift, 0.5 + row, 0}, color);
        }
    }
}

/// Layers of three beams, each across the one below.
void add_beam_tower(DocumentParts& parts, int layers, Vec3 base, Color color) {
    const Quat across = from_axis_angle({0, 1, 0}, std::numbers::pi / 2);
    for (int layer = 0; layer < layers; ++layer) {
        for (int i = -1; i <= 1; ++i) {
            const bool turned = layer % 2 == 1;
            const Vec3 offset = turned ? Vec3{1.0 * i, 0, 0} : Vec3{0, 0, 1.0 * i};
            parts.add("beam", BoxShape{{1.5, 0.25, 0.25}}, base + Vec3{0, 0.25 + 0.5 * layer, 0} + offset, color,
                      turned ? across : Quat{});
        }
    }
}

}  // namespace

scene::Document build_table1_e() {
    DocumentParts parts("Ball hits stacked cubes", "A pyramid of 55 cubes is hit by a ball of 10 t at 20 m/s.");
    parts.set_camera({11, 6, 16}, {0, 3, 0});
    parts.add_ground();
    parts.add_pyramid(10, {}, wood_color);
    add_shot(parts, 0.5, 10000, {0, 3.5, -6}, {0, 0, 20}, 2);
    return parts.take();
}

scene::Document build_table1_f() {
    DocumentParts parts("Wall of 210 cubes", "Three cubes of the lowest row are pushed out of the wall.");
    parts.set_camera({14, 8, 22}, {0, 4, 0});
    parts.add_ground();
    add_wall(parts, 21, 10, {}, stone_color);
    // The ground is entity 1, so the lowest row's cubes are 2 … 22; its middle three go.
    for (const scene::EntityIndex cube : {11u, 12u, 13u}) parts.push_at(2, cube, {0, 0, 10});
    return parts.take();
}

scene::Document build_table1_g() {
    DocumentParts parts("343 primitives", "Spheres, cubes and columns fall into a pen.");
    parts.set_camera({11, 12, 15}, {0, 3, 0});
    parts.add_ground();
    parts.add_pen(6, 6);
    Random random(7);
    const physics::ShapeDefinition shapes[] = {SphereShape{0.25}, BoxShape{{0.25, 0.25, 0.25}},
                                               CylinderShape{0.25, 0.25}};
    const char* const names[] = {"sphere", "cube", "column"};
    const Color colors[] = {accent_color, wood_color, steel_color};
    for (int k = 0; k < 343; ++k) {
        const int kind = k % 3;
        const int row = k / 7 % 7, layer = k / 49;
        const Vec3 place{row - 3 + random.between(-0.05, 0.05), 5.25 + layer, k % 7 - 3 + random.between(-0.05, 0.05)};
        parts.add(names[kind], shapes[kind], place, colors[kind], random_rotation(random));
    }
    return parts.take();
}

scene::Document build_figure_9() {
    DocumentParts parts("Box stack, restitution 0.8", "Ten bouncing boxes fall on one another and settle.");
    parts.set_camera({9, 8, 14}, {0, 6, 0});
    parts.add_ground();
    for (int i = 0; i < 10; ++i) parts.add("box", BoxShape{}, {0, 1.0 + 1.5 * i, 0}, wood_color);
    parts.set_restitution(0.8);
    return parts.take();
}

scene::Document build_figure_10() {
    DocumentParts parts("Complicated stack", "Walls, pyramids, columns and a tower of beams, hit by two balls.");
    parts.set_camera({22, 14, 28}, {0, 4, 0});
    parts.add_ground();
    add_wall(parts, 12, 8, {0, 0, -6}, stone_color);
    parts.add_pyramid(8, {-7, 0, 0}, wood_color);
    parts.add_pyramid(8, {7, 0, 0}, wood_color);
    add_beam_tower(parts, 14, {0, 0, 2}, wood_color);
    // Columns of drums with a lintel of boxes and a ball on it.
    for (const double x : {-9.0, -3.0, 3.0, 9.0}) {
        for (int i = 0; i < 5; ++i) parts.add("drum", CylinderShape{0.5, 0.5}, {x, 0.5 + i, 7}, steel_color);
        parts.add("slab", BoxShape{{1, 0.15, 1}}, {x, 5.15, 7}, stone_color);
        parts.add("ball", SphereShape{0.4}, {x, 5.7, 7}, accent_color);
    }
    add_shot(parts, 0.75, 8000, {0, 4, -16}, {0, 0, 22}, 2);
    add_shot(parts, 0.75, 8000, {-18, 3, 0}, {22, 0, 0}, 4);
    return parts.take();
}

scene::Document build_dog_on_terrain() {
    DocumentParts parts("Dog on a terrain", "A model of 33,854 triangles falls on hills of 115,200 triangles.");
    physics::HeightfieldShape terrain = make_terrain(11);
    const double half = (terrain.columns - 1) * terrain.cell_x / 2;
    const auto columns = static_cast<std::size_t>(terrain.columns), rows = static_cast<std::size_t>(terrain.rows);
    const std::size_t middle = rows / 2 * columns + columns / 2;
    const double ground = static_cast<double>(terrain.heights[middle]);
    parts.set_camera({4, ground + 3, 5}, {0, ground + 0.5, 0});
    parts.add_static("terrain", std::move(terrain), {-half, 0, -half}, {0.2, 0.32, 0.14});
    scene::Entity& dog =
        parts.add("dog", make_dog(33854), {0, ground + 1.5, 0}, {0.45, 0.28, 0.14}, from_axis_angle({0, 0, 1}, 0.3));
    dog.attributes.erase("density");
    dog.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    dog.attributes["mass"] = 30.0;
    return parts.take();
}

scene::Document build_ten_boxes() {
    DocumentParts parts("Ten boxes", "A stack that stands and falls asleep.");
    parts.set_camera({7, 6, 12}, {0, 5, 0});
    parts.add_ground();
    for (int i = 0; i < 10; ++i) parts.add("box", BoxShape{}, {0, 0.5 + i, 0}, wood_color);
    return parts.take();
}

scene::Document build_tall_stack() {
    DocumentParts parts("Column of 30 cubes", "Thirty cubes of 1 m on one another.");
    parts.set_camera({14, 14, 32}, {0, 14, 0});
    parts.add_ground();
    for (int i = 0; i < 30; ++i) parts.add("box", BoxShape{}, {0, 0.5 + i, 0}, wood_color);
    return parts.take();
}

}  // namespace embody::scenes
