// SPDX-License-Identifier: MIT
#include "scene/embody/closed_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "physics/definitions/deformable_primitives.h"

namespace embody::scene {

namespace {

using attributes::SheetMesh;

SheetMesh mesh_of(physics::DeformableDefinition sheet) {
    return {std::move(sheet.nodes), std::move(std::get<physics::Cloth>(sheet.matter).triangles)};
}

}  // namespace

std::optional<SheetMesh> closed_sheet_of(const physics::ShapeDefinition& shape, int nodes) {
    if (const auto* ball = std::get_if<physics::SphereShape>(&shape)) {
        // Equilateral triangles of half a node each.
        const double area = 4 * std::numbers::pi * ball->radius * ball->radius;
        return mesh_of(physics::cloth_sphere(ball->radius, std::sqrt(2 * area / (std::sqrt(3.0) * nodes))));
    }
    if (const auto* box = std::get_if<physics::BoxShape>(&shape)) {
        const Vec3 size = 2 * box->half_extents;
        const double area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
        return mesh_of(physics::cloth_box(size, std::sqrt(area / nodes)));
    }
    return std::nullopt;
}

SheetMesh closed_sheet_of(const geometry::TetrahedralMesh& filling) {
    // Faces that one tetrahedron has, by their nodes in order, as its orientation turns them.
    std::map<std::array<std::uint32_t, 3>, std::array<std::uint32_t, 3>> faces;
    for (const auto& t : filling.tetrahedra) {
        const Vec3 origin = filling.nodes[t[0]];
        const bool is_positive =
            dot(filling.nodes[t[1]] - origin, cross(filling.nodes[t[2]] - origin, filling.nodes[t[3]] - origin)) > 0;
        for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
            std::array face{t[static_cast<std::size_t>(a)], t[static_cast<std::size_t>(b)],
                            t[static_cast<std::size_t>(c)]};
            if (!is_positive) std::swap(face[1], face[2]);
            std::array<std::uint32_t, 3> key = face;
            std::ranges::sort(key);
            if (const auto [place, is_new] = faces.try_emplace(key, face); !is_new) faces.erase(place);
        }
    }
    SheetMesh sheet;
    std::map<std::uint32_t, std::uint32_t> number;
    for (const auto& [key, face] : faces) {
        auto& triangle = sheet.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [place, is_new] = number.try_emplace(face[k], static_cast<std::uint32_t>(sheet.nodes.size()));
            if (is_new) sheet.nodes.push_back(filling.nodes[face[k]]);
            triangle[k] = place->second;
        }
    }
    return sheet;
}

bool is_closed(const SheetMesh& sheet) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : sheet.triangles) {
        for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
    }
    std::ranges::sort(edges);
    if (std::ranges::adjacent_find(edges) != edges.end()) return false;
    return std::ranges::all_of(edges, [&](const auto& edge) {
        return std::ranges::binary_search(edges, std::array{edge[1], edge[0]});
    });
}

}  // namespace embody::scene
