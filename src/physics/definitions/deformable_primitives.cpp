// SPDX-License-Identifier: MIT
#include "physics/definitions/deformable_primitives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace embody::physics {

namespace {

using std::numbers::pi;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Triangles between two rows of nodes, each row by its first node and its count, nodes by how far along they are.
void join_rows(const std::vector<Vec3>& nodes, std::uint32_t first, std::uint32_t first_count, std::uint32_t second,
               std::uint32_t second_count, Triangles& triangles) {
    std::uint32_t a = first, b = second;
    const std::uint32_t last_a = first + first_count - 1, last_b = second + second_count - 1;
    while (a < last_a || b < last_b) {
        // The shorter of the two diagonals.
        const bool goes_on_a = b == last_b || (a < last_a && length_squared(nodes[a + 1] - nodes[b]) <=
                                                                 length_squared(nodes[b + 1] - nodes[a]));
        if (goes_on_a) {
            triangles.push_back({a, b, a + 1});
            ++a;
        } else {
            triangles.push_back({a, b, b + 1});
            ++b;
        }
    }
}

}  // namespace

DeformableDefinition cloth_rectangle(double size_x, double size_z, double edge, Cloth cloth) {
    DeformableDefinition sheet;
    const int columns = std::max(1, static_cast<int>(std::lround(size_x / edge)));
    const int rows = std::max(1, static_cast<int>(std::lround(size_z / (edge * std::sqrt(0.75)))));
    std::uint32_t before = 0, before_count = 0;
    for (int r = 0; r <= rows; ++r) {
        const auto first = static_cast<std::uint32_t>(sheet.nodes.size());
        const double z = size_z * (static_cast<double>(r) / rows - 0.5), half = size_x / 2;
        const auto at = [&](double step) { return Vec3{size_x * step / columns - half, 0, z}; };
        // Odd rows lie half an edge off, with a node at each border.
        sheet.nodes.push_back({-half, 0, z});
        for (int c = 1; c <= columns; ++c) {
            if (r % 2 == 1)
                sheet.nodes.push_back(at(c - 0.5));
            else if (c < columns)
                sheet.nodes.push_back(at(c));
        }
        sheet.nodes.push_back({half, 0, z});
        const auto count = static_cast<std::uint32_t>(sheet.nodes.size()) - first;
        if (r > 0) join_rows(sheet.nodes, before, before_count, first, count, cloth.triangles);
        before = first;
        before_count = count;
    }
    sheet.matter = std::move(cloth);
    return sheet;
}

DeformableDefinition cloth_disc(double radius, double edge, Cloth cloth) {
    DeformableDefinition sheet;
    const int rings = std::max(1, static_cast<int>(std::lround(radius / edge)));
    sheet.nodes.push_back({0, 0, 0});
    const auto first_of = [](int ring) { return static_cast<std::uint32_t>(1 + 3 * ring * (ring - 1)); };
    for (int ring = 1; ring <= rings; ++ring) {
        for (int k = 0; k < 6 * ring; ++k) {
            const double angle = 2 * pi * k / (6 * ring), distance = radius * ring / rings;
            sheet.nodes.push_back({distance * std::cos(angle), 0, distance * std::sin(angle)});
        }
    }
    for (std::uint32_t k = 0; k < 6; ++k) cloth.triangles.push_back({0, 1 + (k + 1) % 6, 1 + k});
    for (int ring = 2; ring <= rings; ++ring) {
        const std::uint32_t inner = first_of(ring - 1), outer = first_of(ring);
        const auto inner_count = static_cast<std::uint32_t>(6 * (ring - 1)), outer_count = inner_count + 6;
        const auto r = static_cast<std::uint32_t>(ring);
        for (std::uint32_t sector = 0; sector < 6; ++sector) {
            for (std::uint32_t k = 0; k < r; ++k) {
                const std::uint32_t a = inner + (sector * (r - 1) + k) % inner_count;
                const std::uint32_t b = outer + sector * r + k, c = outer + (sector * r + k + 1) % outer_count;
                cloth.triangles.push_back({a, c, b});
                if (k + 1 < r) cloth.triangles.push_back({a, inner + (sector * (r - 1) + k + 1) % inner_count, c});
            }
        }
    }
    sheet.matter = std::move(cloth);
    return sheet;
}

DeformableDefinition cloth_ball(double radius, double edge, Cloth cloth) {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec3> corners;
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-golden, golden}) {
            corners.insert(corners.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});
        }
    }
    const int parts = std::max(1, static_cast<int>(std::lround(radius * 2 / length(corners[0]) / edge)));
    DeformableDefinition sheet;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> known;  // nodes by place: faces share those of their edges
    const auto node_at = [&](Vec3 place) {
        constexpr double grid =
            1e6;  // cells in half an edge of the icosahedron. Test: SheetGas.ABallIsClosedAndHasItsVolume
        const auto [node, is_new] = known.try_emplace(
            {std::llround(grid * place.x), std::llround(grid * place.y), std::llround(grid * place.z)},
            static_cast<std::uint32_t>(sheet.nodes.size()));
        if (is_new) sheet.nodes.push_back(radius * normalized(place));
        return node->second;
    };
    const auto are_neighbours = [&](Vec3 a, Vec3 b) { return std::fabs(length(a - b) - 2) < 0.1; };
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t j = i + 1; j < corners.size(); ++j) {
            for (std::size_t k = j + 1; k < corners.size(); ++k) {
                const Vec3 a = corners[i];
                Vec3 b = corners[j], c = corners[k];
                if (!are_neighbours(a, b) || !are_neighbours(b, c) || !are_neighbours(c, a)) continue;
                if (dot(a, cross(b, c)) < 0) std::swap(b, c);
                const auto at = [&](int u, int v) { return node_at(a + (u * (b - a) + v * (c - a)) / parts); };
                for (int u = 0; u < parts; ++u) {
                    for (int v = 0; u + v < parts; ++v) {
                        cloth.triangles.push_back({at(u, v), at(u + 1, v), at(u, v + 1)});
                        if (u + v + 1 < parts)
                            cloth.triangles.push_back({at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)});
                    }
                }
            }
        }
    }
    sheet.matter = std::move(cloth);
    return sheet;
}

DeformableDefinition rope_between(Vec3 from, Vec3 to, double segment, Rope rope) {
    DeformableDefinition line;
    const int segments = std::max(1, static_cast<int>(std::ceil(length(to - from) / segment - 1e-9)));
    for (int k = 0; k <= segments; ++k) line.nodes.push_back(from + (static_cast<double>(k) / segments) * (to - from));
    line.matter = rope;
    return line;
}

DeformableDefinition tetrahedral_brick(Vec3 size, std::array<int, 3> cells, SoftSolid solid) {
    DeformableDefinition brick;
    solid.tetrahedra.clear();
    const int nx = cells[0], ny = cells[1], nz = cells[2];
    const auto at = [&](int x, int y, int z) { return static_cast<std::uint32_t>((z * (ny + 1) + y) * (nx + 1) + x); };
    for (int z = 0; z <= nz; ++z) {
        for (int y = 0; y <= ny; ++y) {
            for (int x = 0; x <= nx; ++x) brick.nodes.push_back({size.x * x / nx, size.y * y / ny, size.z * z / nz});
        }
    }
    // Kuhn's split along the diagonal from (0,0,0) to (1,1,1), mirrored in cells of odd place.
    constexpr int permutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int z = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
            for (int x = 0; x < nx; ++x) {
                const std::array<int, 3> odd{x % 2, y % 2, z % 2};
                for (const auto& permutation : permutations) {
                    std::array<int, 3> corner{0, 0, 0};
                    std::array<std::uint32_t, 4> element{};
                    for (std::size_t k = 0; k < 4; ++k) {
                        element[k] = at(x + (corner[0] ^ odd[0]), y + (corner[1] ^ odd[1]), z + (corner[2] ^ odd[2]));
                        if (k < 3) corner[static_cast<std::size_t>(permutation[k])] = 1;
                    }
                    solid.tetrahedra.push_back(element);
                }
            }
        }
    }
    brick.matter = std::move(solid);
    return brick;
}

}  // namespace embody::physics
