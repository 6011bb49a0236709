// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "geometry/triangle_mesh.h"
#include "math/transform.h"

namespace embody::geometry {

constexpr double pi = std::numbers::pi;

/// Box of the given half extents about `center`, 12 triangles.
inline TriangleMesh make_box(Vec3 half, Vec3 center = {}) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        const Vec3 sign{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
        mesh.positions.push_back(to_vec3f(center + scale(sign, half)));
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Surface (u, v) ↦ point(u, v), u and v in [0, 1], as a grid of its own vertices (seams are not shared).
template <class Point>
TriangleMesh make_grid(int columns, int rows, Point point) {
    TriangleMesh mesh;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            mesh.positions.push_back(to_vec3f(point(double(i % columns) / columns, double(j) / rows)));
        }
    }
    const auto at = [&](int i, int j) { return std::uint32_t(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    }
    return mesh;
}

/// Latitude-longitude sphere, top pole first; pole triangles are degenerate until welded.
inline TriangleMesh make_sphere(double radius, int columns = 64, int rows = 32, Vec3 center = {}) {
    return make_grid(columns, rows, [=](double u, double v) {
        const double ring = v == 0 || v == 1 ? 0 : std::sin(pi * v);
        return center + radius * Vec3{ring * std::sin(2 * pi * u), std::cos(pi * v), ring * std::cos(2 * pi * u)};
    });
}

/// Upright cylinder with both caps (a fan to the centre).
inline TriangleMesh make_cylinder(double radius, double half_height, int columns = 48) {
    return make_grid(columns, 3, [=](double u, double v) {
        const double r = v > 0.1 && v < 0.9 ? radius : 0;
        return Vec3{r * std::sin(2 * pi * u), v < 0.5 ? half_height : -half_height, r * std::cos(2 * pi * u)};
    });
}

/// Torus about the y axis.
inline TriangleMesh make_torus(double ring, double tube, int columns = 64, int rows = 32) {
    return make_grid(columns, rows, [=](double u, double v) {
        const double angle = v >= 1 ? 0 : 2 * pi * v;
        const double r = ring + tube * std::sin(angle);
        return Vec3{r * std::sin(2 * pi * u), tube * std::cos(angle), r * std::cos(2 * pi * u)};
    });
}

/// A copy in which each triangle has its own vertices, as in many real files.
inline TriangleMesh make_soup(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const auto& triangle : mesh.triangles) {
        const auto first = std::uint32_t(soup.positions.size());
        for (const std::uint32_t vertex : triangle) soup.positions.push_back(mesh.positions[vertex]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

inline TriangleMesh moved(TriangleMesh mesh, const Transform& t) {
    for (Vec3f& p : mesh.positions) p = to_vec3f(transform_point(t, to_vec3(p)));
    return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace embody::geometry
