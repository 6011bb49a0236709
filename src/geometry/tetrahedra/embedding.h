// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// The position of a point in a tetrahedron: it keeps its barycentric coordinates while the nodes move.
struct EmbeddedPoint {
    std::uint32_t tetrahedron = 0;
    std::array<double, 4> weights{};  ///< of its nodes; their sum is 1, and some are negative outside of it
};

/// For each position the tetrahedron around it, or the one whose outer face is nearest where there is none. Errors: a
/// mesh without tetrahedra or surface, a position that is not finite.
Result<std::vector<EmbeddedPoint>> embed(const std::vector<Vec3f>& positions, const TetrahedralMesh& mesh);

/// The point's position when the nodes are at `nodes`, as many as the mesh had.
Vec3 position(const EmbeddedPoint& point, const TetrahedralMesh& mesh, const std::vector<Vec3>& nodes);

}  // namespace embody::geometry
