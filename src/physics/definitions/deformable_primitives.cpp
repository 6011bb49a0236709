// SPDX-License-Identifier: MIT
#include "physics/definitions/deformable_primitives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

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

DeformableDefinition cloth_sphere(double radius, double edge, Cloth cloth) {
    // The corners (0, ±1, ±φ) turned round the axes, and the faces between them.
    constexpr double phi = std::numbers::phi;
    std::vector<Vec3> corners;
    for (const double one : {-1.0, 1.0}) {
        for (const double far : {-phi, phi})
            corners.insert(corners.end(), {{0, one, far}, {one, far, 0}, {far, 0, one}});
    }
    const auto are_neighbours = [&](std::size_t a, std::size_t b) { return length(corners[a] - corners[b]) < 2.1; };
    const double arc = std::atan(2.0);  // between neighbours
    const int rows = std::max(1, static_cast<int>(std::lround(radius * arc / edge)));

    DeformableDefinition sphere;
    std::map<std::array<int, 12>, std::uint32_t> number;  // of a node by its weights of the corners, in rows
    const auto node_at = [&](const std::array<std::size_t, 3>& face, int b, int c) {
        std::array<int, 12> weight{};
        weight[face[0]] = rows - b - c;
        weight[face[1]] = b;
        weight[face[2]] = c;
        const auto [place, is_new] = number.try_emplace(weight, static_cast<std::uint32_t>(sphere.nodes.size()));
        if (is_new) {
            Vec3 sum;
            for (std::size_t k = 0; k < 12; ++k) sum += static_cast<double>(weight[k]) * corners[k];
            sphere.nodes.push_back(radius * normalized(sum));
        }
        return place->second;
    };
    cloth.triangles.clear();
    for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t k = i + 1; k < 12; ++k) {
            for (std::size_t l = k + 1; l < 12; ++l) {
                if (!are_neighbours(i, k) || !are_neighbours(k, l) || !are_neighbours(l, i)) continue;
                const bool is_outward = dot(corners[i], cross(corners[k], corners[l])) > 0;
                const std::array<std::size_t, 3> face{i, is_outward ? k : l, is_outward ? l : k};
                for (int b = 0; b < rows; ++b) {
                    for (int c = 0; b + c < rows; ++c) {
                        const std::uint32_t next_b = node_at(face, b + 1, c), next_c = node_at(face, b, c + 1);
                        cloth.triangles.push_back({node_at(face, b, c), next_b, next_c});
                        if (b + c + 1 < rows) cloth.triangles.push_back({next_b, node_at(face, b + 1, c + 1), next_c});
                    }
                }
            }
        }
    }
    sphere.matter = std::move(cloth);
    return sphere;
}

DeformableDefinition cloth_box(Vec3 size, double edge, Cloth cloth) {
    DeformableDefinition box;
    std::array<int, 3> cells{};
    for (int axis = 0; axis < 3; ++axis)
        cells[static_cast<std::size_t>(axis)] = std::max(1, static_cast<int>(std::lround(size[axis] / edge)));
    std::map<std::array<int, 3>, std::uint32_t> number;  // of a node by its place in cells
    const auto node_at = [&](const std::array<int, 3>& cell) {
        const auto [place, is_new] = number.try_emplace(cell, static_cast<std::uint32_t>(box.nodes.size()));
        if (is_new) {
            Vec3 node;
            for (std::size_t axis = 0; axis < 3; ++axis)
                node[static_cast<int>(axis)] =
                    size[static_cast<int>(axis)] * (static_cast<double>(cell[axis]) / cells[axis] - 0.5);
            box.nodes.push_back(node);
        }
        return place->second;
    };
    cloth.triangles.clear();
    for (std::size_t across = 0; across < 3; ++across) {
        const std::size_t u = (across + 1) % 3, v = (across + 2) % 3;
        for (const bool is_upper : {false, true}) {
            for (int i = 0; i < cells[u]; ++i) {
                for (int k = 0; k < cells[v]; ++k) {
                    const auto corner = [&](int right, int up) {
                        std::array<int, 3> cell{};
                        cell[across] = is_upper ? cells[across] : 0;
                        cell[u] = i + right;
                        cell[v] = k + up;
                        return node_at(cell);
                    };
                    std::array<std::uint32_t, 4> square{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    if (!is_upper) std::swap(square[1], square[3]);
                    // Diagonals by turns, so that the whole has no handedness.
                    if ((i + k) % 2 == 1) std::ranges::rotate(square, square.begin() + 1);
                    cloth.triangles.push_back({square[0], square[1], square[2]});
                    cloth.triangles.push_back({square[0], square[2], square[3]});
                }
            }
        }
    }
    box.matter = std::move(cloth);
    return box;
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
