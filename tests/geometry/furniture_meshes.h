// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/sample_meshes.h"

namespace embody::geometry {

/// Surface of revolution of a line in the plane (radius, height) about the y axis.
inline TriangleMesh make_turned(const std::vector<std::array<double, 2>>& line, int columns = 32) {
    const int rows = static_cast<int>(line.size()) - 1;
    return make_grid(columns, rows, [&](double u, double v) {
        const auto [radius, height] = line[static_cast<std::size_t>(std::lround(v * rows))];
        return Vec3{radius * std::sin(2 * pi * u), height, radius * std::cos(2 * pi * u)};
    });
}

/// A mug without handle, 8 cm wide and 10 cm high, walls of 5 mm: a closed surface.
inline TriangleMesh make_mug() {
    return make_turned({{0, 0.005}, {0.035, 0.005}, {0.035, 0.1}, {0.04, 0.1}, {0.04, 0}, {0, 0}});
}
/// The same without thickness: bottom and wall as one open sheet.
inline TriangleMesh make_open_mug() { return make_turned({{0.04, 0.1}, {0.04, 0}, {0, 0}}); }

/// Seat at 0.44 … 0.46 m, back up to 0.9 m, four legs: six boxes that touch.
inline TriangleMesh make_chair() {
    TriangleMesh mesh = make_box({0.2, 0.01, 0.2}, {0, 0.45, 0});
    append(mesh, make_box({0.2, 0.22, 0.01}, {0, 0.68, -0.19}));
    for (const double x : {-0.18, 0.18}) {
        for (const double z : {-0.18, 0.18}) append(mesh, make_box({0.02, 0.22, 0.02}, {x, 0.22, z}));
    }
    return mesh;
}

/// A plate at 0.71 … 0.75 m, 1.4 m by 0.8 m, on four legs.
inline TriangleMesh make_table() {
    TriangleMesh mesh = make_box({0.7, 0.02, 0.4}, {0, 0.73, 0});
    for (const double x : {-0.65, 0.65}) {
        for (const double z : {-0.35, 0.35}) append(mesh, make_box({0.03, 0.355, 0.03}, {x, 0.355, z}));
    }
    return mesh;
}

/// Two bars of 1 m by 0.2 m by 0.2 m that meet at a corner, as one closed surface.
inline TriangleMesh make_angle() {
    const std::vector<std::array<double, 2>> outline{{0, 0}, {1, 0}, {1, 0.2}, {0.2, 0.2}, {0.2, 1}, {0, 1}};
    TriangleMesh mesh;
    for (const double z : {0.0, 0.2}) {
        for (const auto& [x, y] : outline) mesh.positions.push_back(to_vec3f({x, y, z}));
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (std::uint32_t i = 0; i < 6; ++i) quad(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6);
    quad(6, 7, 8, 9);
    quad(6, 9, 10, 11);
    quad(3, 2, 1, 0);
    quad(5, 4, 3, 0);
    return mesh;
}

}  // namespace embody::geometry
