// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"

namespace embody::geometry {

/// Indexed triangles, counter-clockwise seen from outside. Metres.
struct TriangleMesh {
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Bounds of the vertices that triangles use; empty where there are no triangles.
Bounds bounds(const TriangleMesh& mesh);

/// Whether every index names a vertex and every used vertex is finite; the error names the first wrong triangle.
/// All meshes from files are checked here first: the functions of this layer rely on both.
Result<void> validate(const TriangleMesh& mesh);

/// Sum of the triangles' areas, m².
double surface_area(const TriangleMesh& mesh);

/// The corners of triangle `index` in double precision.
inline std::array<Vec3, 3> corners(const TriangleMesh& mesh, std::size_t index) {
    const auto& t = mesh.triangles[index];
    return {to_vec3(mesh.positions[t[0]]), to_vec3(mesh.positions[t[1]]), to_vec3(mesh.positions[t[2]])};
}

}  // namespace embody::geometry
