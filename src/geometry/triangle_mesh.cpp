// SPDX-License-Identifier: MIT
#include "geometry/triangle_mesh.h"

#include "foundation/assert.h"

namespace embody::geometry {

Bounds bounds(const TriangleMesh& mesh) {
    Bounds box;
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle) {
            EMBODY_ASSERT(vertex < mesh.positions.size());
            box.add(to_vec3(mesh.positions[vertex]));
        }
    }
    return box;
}

Result<void> validate(const TriangleMesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t vertex : mesh.triangles[i]) {
            if (vertex >= mesh.positions.size()) {
                return Error{"triangle " + std::to_string(i), "points to vertex " + std::to_string(vertex) +
                                                                  ", but the mesh has only " +
                                                                  std::to_string(mesh.positions.size())};
            }
            if (!is_finite(to_vec3(mesh.positions[vertex]))) {
                return Error{"triangle " + std::to_string(i),
                             "vertex " + std::to_string(vertex) + " is not a finite point"};
            }
        }
    }
    return {};
}

double surface_area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = corners(mesh, i);
        sum += 0.5 * length(cross(b - a, c - a));
    }
    return sum;
}

}  // namespace embody::geometry
