// SPDX-License-Identifier: MIT
// Stacks of boxes and what else lies flat on one another.
#include <algorithm>
#include <numbers>

#include "foundation/random.h"
#include "scenes/structures/building.h"

namespace embody::scenes {

using physics::BoxShape;
using physics::CylinderShape;
using physics::Material;
using physics::SphereShape;
using physics::WorldSettings;

namespace {

const Quat quarter_turn = from_axis_angle({0, 1, 0}, std::numbers::pi / 2);

/// Unit cubes on one another; each `factor` times as heavy as the one below, 1 kg at the bottom.
Structure build_growing_column(const WorldSettings& settings, int count, double factor) {
    Building building(settings, {});
    const auto cube = building.shape(BoxShape{});
    double mass = 1;
    for (int i = 0; i < count; ++i, mass *= factor) building.add(cube, {0, 0.5 + i, 0}, {}, mass);
    return building.take(0.5);
}

Structure build_column(const WorldSettings& settings, int count) {
    Building building(settings, {});
    const auto cube = building.shape(BoxShape{});
    for (int i = 0; i < count; ++i) building.add(cube, {0, 0.5 + i, 0});
    return building.take(0.5);
}

/// Unit cubes in the plane z = center.z, `base` of them in the lowest row, each on two of the row below.
void add_pyramid(Building& building, int base, Vec3 center) {
    const auto cube = building.shape(BoxShape{});
    for (int row = 0; row < base; ++row) {
        for (int i = 0; i < base - row; ++i)
            building.add(cube, center + Vec3{i - 0.5 * (base - 1 - row), 0.5 + row, 0});
    }
}

Structure build_pyramid(const WorldSettings& settings, int base) {
    Building building(settings, {});
    add_pyramid(building, base, {});
    // What has not fallen may sag a few per cent of its height: that is measured.
    return building.take(std::max(0.5, 0.02 * base));
}

/// Unit cubes in running bond, `columns` of them in the lowest row and one fewer in every second row.
void add_wall(Building& building, int columns, int rows, Vec3 center) {
    const auto cube = building.shape(BoxShape{});
    for (int row = 0; row < rows; ++row) {
        const int count = columns - row % 2;
        for (int i = 0; i < count; ++i) building.add(cube, center + Vec3{i - (count - 1) / 2.0, 0.5 + row, 0});
    }
}

/// Layers of three beams, each across the one below; `pitch` (m) from beam to beam.
void add_beam_tower(Building& building, int layers, Vec3 half, double pitch, Vec3 base) {
    const auto beam = building.shape(BoxShape{half});
    for (int layer = 0; layer < layers; ++layer) {
        const bool turned = layer % 2 == 1;
        for (int i = -1; i <= 1; ++i) {
            const Vec3 offset = turned ? Vec3{pitch * i, 0, 0} : Vec3{0, 0, pitch * i};
            const Vec3 position = base + Vec3{0, half.y * (1 + 2 * layer), 0} + offset;
            building.add(beam, position, turned ? quarter_turn : Quat{});
        }
    }
}

}  // namespace

Structure build_column_10(const WorldSettings& settings) { return build_column(settings, 10); }
Structure build_column_30(const WorldSettings& settings) { return build_column(settings, 30); }
Structure build_mass_ratio_1000(const WorldSettings& settings) { return build_growing_column(settings, 2, 1000); }
Structure build_tower_10000(const WorldSettings& settings) { return build_growing_column(settings, 5, 10); }
Structure build_pyramid_10(const WorldSettings& settings) { return build_pyramid(settings, 10); }
Structure build_pyramid_60(const WorldSettings& settings) { return build_pyramid(settings, 60); }
Structure build_pyramid_100(const WorldSettings& settings) { return build_pyramid(settings, 100); }

// Paper, Figure 9.
Structure build_restitution_stack(const WorldSettings& settings) {
    Building building(settings, {.restitution = 0.8});
    const auto cube = building.shape(BoxShape{});
    for (int i = 0; i < 10; ++i) building.drop(cube, {0, 1 + 1.5 * i, 0}, {0, 0.5 + i, 0});
    return building.take(0.5);
}

Structure build_wall(const WorldSettings& settings) {
    Building building(settings, {});
    add_wall(building, 21, 10, {});
    return building.take(0.5);
}

// Paper, Figure 10, before anything hits it.
Structure build_figure_10(const WorldSettings& settings) {
    Building building(settings, {});
    add_wall(building, 12, 8, {0, 0, -6});
    add_pyramid(building, 8, {-7, 0, 0});
    add_pyramid(building, 8, {7, 0, 0});
    add_beam_tower(building, 14, {1.5, 0.25, 0.25}, 1, {0, 0, 2});
    const auto drum = building.shape(CylinderShape{0.5, 0.5});
    const auto slab = building.shape(BoxShape{{1, 0.15, 1}});
    for (const double x : {-9.0, -3.0, 3.0, 9.0}) {
        for (int i = 0; i < 5; ++i) building.add(drum, {x, 0.5 + i, 7});
        building.add(slab, {x, 5.15, 7});
    }
    return building.take(0.5);
}

// The game's blocks of 75 x 25 x 15 mm, 18 layers of three; wood.
Structure build_jenga(const WorldSettings& settings) {
    Building building(settings, {});
    building.set_density(600);
    add_beam_tower(building, 18, {0.0375, 0.0075, 0.0125}, 0.0251, {});
    return building.take(0.0075);
}

// The same, 40 times as large.
Structure build_large_jenga(const WorldSettings& settings) {
    Building building(settings, {});
    building.set_density(600);
    add_beam_tower(building, 18, {1.5, 0.3, 0.5}, 1.004, {});
    return building.take(0.3);
}

// The game's stones of 48 x 24 x 7.5 mm, 20 mm between two of them; nobody pushes the first.
Structure build_dominoes(const WorldSettings& settings) {
    Building building(settings, {});
    building.set_density(1180);
    const auto stone = building.shape(BoxShape{{0.00375, 0.024, 0.012}});
    for (int i = 0; i < 60; ++i) building.add(stone, {0.0275 * i, 0.024, 0});
    return building.take(0.00375);
}

// Table I (g) of the paper: spheres, cubes and columns fall into a pen. Real ones do not roll for ever: a ball of wood
// has a lever arm of some tenths of a millimetre.
Structure build_pen(const WorldSettings& settings) {
    Building building(settings, {.friction_rolling = 0.002, .friction_torsional = 0.002});
    const auto along_x = building.shape(BoxShape{{7, 3, 0.5}}), along_z = building.shape(BoxShape{{0.5, 3, 7}});
    for (const double side : {-6.5, 6.5}) {
        building.add_static(along_x, {0, 3, side});
        building.add_static(along_z, {side, 3, 0});
    }
    const physics::ShapeHandle shapes[] = {building.shape(SphereShape{0.25}),
                                           building.shape(BoxShape{{0.25, 0.25, 0.25}}),
                                           building.shape(CylinderShape{0.25, 0.25})};
    Random random(7);
    for (int k = 0; k < 343; ++k) {
        const Vec3 place{k / 7 % 7 - 3 + random.between(-0.05, 0.05), 5.25 + k / 49,
                         k % 7 - 3 + random.between(-0.05, 0.05)};
        const Quat turn{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        building.add(shapes[k % 3], place, normalized(turn));
    }
    return building.take(0);
}

}  // namespace embody::scenes
