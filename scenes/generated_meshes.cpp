// SPDX-License-Identifier: MIT
#include "scenes/generated_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "foundation/random.h"

namespace embody::scenes {
namespace {

constexpr std::size_t dog_triangles = 33854;
constexpr int meridians = 130;
constexpr int rings = 129;  // between the poles

/// A swelling of the surface in a direction: how far, and how wide (rad).
struct Swelling {
    Vec3 direction;
    double height, width;
};

// Directions from the middle of the trunk; lengths in the trunk's mean radius.
const std::array<Swelling, 10>& dog_swellings() {
    static const std::array<Swelling, 10> swellings = {{
        {normalized(Vec3{1.0, 0.55, 0.0}), 1.5, 0.28},    // head
        {normalized(Vec3{1.0, 0.42, 0.0}), 0.7, 0.12},    // snout
        {normalized(Vec3{0.75, 0.75, 0.18}), 0.6, 0.09},  // ears
        {normalized(Vec3{0.75, 0.75, -0.18}), 0.6, 0.09},
        {normalized(Vec3{0.55, -1.0, 0.35}), 1.3, 0.16},  // fore legs
        {normalized(Vec3{0.55, -1.0, -0.35}), 1.3, 0.16},
        {normalized(Vec3{-0.55, -1.0, 0.35}), 1.3, 0.16},  // hind legs
        {normalized(Vec3{-0.55, -1.0, -0.35}), 1.3, 0.16},
        {normalized(Vec3{-1.0, 0.35, 0.0}), 1.2, 0.10},  // tail
        {Vec3{1, 0, 0}, 0.25, 0.5},                      // chest
    }};
    return swellings;
}

Vec3 dog_surface(Vec3 direction, Random& random) {
    double radius = 1;
    for (const Swelling& swelling : dog_swellings()) {
        const double angle = std::acos(std::clamp(dot(direction, swelling.direction), -1.0, 1.0));
        radius += swelling.height * std::exp(-angle * angle / (2 * swelling.width * swelling.width));
    }
    const double fur = 0.01 * random.between(-1, 1);
    // The trunk is longer than wide; 0.22 m of mean radius.
    return 0.22 * (radius + fur) * scale(direction, {1.5, 1.0, 0.8});
}

}  // namespace

physics::MeshShape make_dog(std::uint64_t seed) {
    Random random(seed);
    physics::MeshShape mesh;
    const auto add_point = [&](Vec3 direction) {
        mesh.positions.push_back(to_vec3f(dog_surface(direction, random)));
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };

    // A sphere of rings and meridians, triangles counter-clockwise seen from outside.
    const std::uint32_t north = add_point({0, 1, 0});
    for (int ring = 1; ring <= rings; ++ring) {
        const double polar = std::numbers::pi * ring / (rings + 1);
        for (int i = 0; i < meridians; ++i) {
            const double azimuth = 2 * std::numbers::pi * i / meridians;
            add_point({std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)});
        }
    }
    const std::uint32_t south = add_point({0, -1, 0});
    const auto at = [](int ring, int i) {
        return static_cast<std::uint32_t>(1 + (ring - 1) * meridians + i % meridians);
    };
    for (int i = 0; i < meridians; ++i) {
        mesh.triangles.push_back({north, at(1, i + 1), at(1, i)});
        for (int ring = 1; ring < rings; ++ring) {
            mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
            mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
        }
        mesh.triangles.push_back({south, at(rings, i), at(rings, i + 1)});
    }

    // Each point put into a triangle makes two more of it, until the count is the paper's.
    for (std::size_t next = 1; mesh.triangles.size() < dog_triangles; next += 97) {
        const std::array<std::uint32_t, 3> corners = mesh.triangles[next];
        const auto middle = [&](float Vec3f::*axis) {
            return (mesh.positions[corners[0]].*axis + mesh.positions[corners[1]].*axis +
                    mesh.positions[corners[2]].*axis) /
                   3;
        };
        mesh.positions.push_back({middle(&Vec3f::x), middle(&Vec3f::y), middle(&Vec3f::z)});
        const auto m = static_cast<std::uint32_t>(mesh.positions.size() - 1);
        mesh.triangles[next] = {corners[0], corners[1], m};
        mesh.triangles.push_back({corners[1], corners[2], m});
        mesh.triangles.push_back({corners[2], corners[0], m});
    }

    // Feet on the ground.
    float lowest = std::numeric_limits<float>::max();
    for (const Vec3f& p : mesh.positions) lowest = std::min(lowest, p.y);
    for (Vec3f& p : mesh.positions) p.y -= lowest;
    return mesh;
}

physics::HeightfieldShape make_terrain(std::uint64_t seed) {
    constexpr int cells = 240;
    constexpr double cell = 0.5;
    physics::HeightfieldShape terrain;
    terrain.columns = cells + 1;
    terrain.rows = cells + 1;
    terrain.cell_x = cell;
    terrain.cell_z = cell;
    terrain.heights.reserve(static_cast<std::size_t>(terrain.columns) * static_cast<std::size_t>(terrain.rows));

    // A few waves of seeded direction, from wide hills to bumps.
    struct Wave {
        double x, z, phase, height;
    };
    Random random(seed);
    std::array<Wave, 8> waves{};
    for (std::size_t i = 0; i < waves.size(); ++i) {
        const double length = 40 / (1 + static_cast<double>(i));
        const double angle = random.between(0, 2 * std::numbers::pi);
        const double number = 2 * std::numbers::pi / length;
        waves[i] = {number * std::cos(angle), number * std::sin(angle), random.between(0, 2 * std::numbers::pi),
                    0.03 * length};
    }
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            double height = 0;
            for (const Wave& wave : waves)
                height += wave.height * std::sin(wave.x * cell * column + wave.z * cell * row + wave.phase);
            terrain.heights.push_back(static_cast<float>(height));
        }
    }
    return terrain;
}

}  // namespace embody::scenes
