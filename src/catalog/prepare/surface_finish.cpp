// SPDX-License-Identifier: MIT
#include "catalog/prepare/surface_finish.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "math/vec3.h"

namespace embody::catalog {
namespace {

using interchange::RawMesh;
using interchange::RawScene;

const double smooth_below = std::cos(40.0 * 3.14159265358979323846 / 180.0);
constexpr std::size_t max_neighbours = 64;  // at one point; more are a fan whose middle may shade flat

/// For each vertex the number of its place: vertices at equal positions have the same one.
std::vector<std::uint32_t> places_of(const std::vector<Vec3f>& positions) {
    std::vector<std::uint32_t> order(positions.size()), place(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i]) != key(order[i - 1])) ++number;
        place[order[i]] = number;
    }
    return place;
}

/// The mesh with three vertices of its own for each triangle, and their crease normals.
void add_crease_normals(RawMesh& mesh) {
    const std::vector<std::uint32_t> place = places_of(mesh.positions);
    const std::size_t count = mesh.triangles.size();

    // Area-weighted normals of the triangles, and the triangles around each place.
    std::vector<Vec3> areas(count);
    std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto& t = mesh.triangles[i];
        const Vec3 a = to_vec3(mesh.positions[t[0]]);
        areas[i] = cross(to_vec3(mesh.positions[t[1]]) - a, to_vec3(mesh.positions[t[2]]) - a);
        for (const std::uint32_t corner : t) around[place[corner]].push_back(i);
    }

    // A corner's normal: the sum of those neighbours that are not beyond a crease.
    RawMesh cornered{.name = mesh.name,
                     .material = mesh.material,
                     .positions = {},
                     .normals = {},
                     .texture_coordinates = {},
                     .triangles = {}};
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 own = normalized(areas[i]);
        for (const std::uint32_t corner : mesh.triangles[i]) {
            Vec3 sum = areas[i];
            const auto& neighbours = around[place[corner]];
            for (std::size_t k = 0; k < std::min(neighbours.size(), max_neighbours); ++k) {
                const std::uint32_t other = neighbours[k];
                if (other != i && dot(normalized(areas[other]), own) > smooth_below) sum += areas[other];
            }
            cornered.positions.push_back(mesh.positions[corner]);
            cornered.normals.push_back(to_vec3f(normalized(sum, {0, 1, 0})));
            if (!mesh.texture_coordinates.empty())
                cornered.texture_coordinates.push_back(mesh.texture_coordinates[corner]);
        }
        cornered.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    mesh = std::move(cornered);
}

/// Whether some edge of the meshes has more triangles in one direction than in the other.
bool is_open(const std::vector<const RawMesh*>& meshes) {
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const RawMesh* mesh : meshes) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), mesh->positions.begin(), mesh->positions.end());
        for (const auto& t : mesh->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    const std::vector<std::uint32_t> place = places_of(positions);

    // Each edge as its ordered pair of places and +1 or -1 for the direction; a closed surface sums to 0 everywhere.
    std::vector<std::pair<std::uint64_t, int>> edges;
    edges.reserve(3 * triangles.size());
    for (const auto& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = place[t[k]], b = place[t[(k + 1) % 3]];
            if (a != b) edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        int sum = 0;
        const std::uint64_t edge = edges[i].first;
        for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
        if (sum != 0) return true;
    }
    return false;
}

}  // namespace

void finish_surfaces(RawScene& scene) {
    for (std::size_t material = 0; material < scene.materials.size(); ++material) {
        if (!scene.materials[material].double_sided) continue;
        std::vector<const RawMesh*> meshes;
        for (const RawMesh& mesh : scene.meshes) {
            if (mesh.material == static_cast<int>(material)) meshes.push_back(&mesh);
        }
        scene.materials[material].double_sided = is_open(meshes);
    }
    for (RawMesh& mesh : scene.meshes) {
        if (mesh.normals.empty()) add_crease_normals(mesh);
    }
}

std::vector<std::string> material_names_by_area(const RawScene& scene) {
    std::vector<double> areas(scene.materials.size());
    for (const RawMesh& mesh : scene.meshes) {
        if (mesh.material < 0) continue;
        for (const auto& t : mesh.triangles) {
            const Vec3 a = to_vec3(mesh.positions[t[0]]);
            areas[static_cast<std::size_t>(mesh.material)] +=
                length(cross(to_vec3(mesh.positions[t[1]]) - a, to_vec3(mesh.positions[t[2]]) - a)) / 2;
        }
    }
    std::vector<std::size_t> order(areas.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return areas[a] > areas[b]; });
    std::vector<std::string> names;
    for (const std::size_t i : order) {
        if (areas[i] > 0) names.push_back(scene.materials[i].name);
    }
    return names;
}

}  // namespace embody::catalog
