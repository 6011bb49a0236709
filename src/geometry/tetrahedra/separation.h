// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/tetrahedra/tetrahedral_mesh.h"

namespace embody::geometry {

/// Leaves tetrahedra connected through faces only: where they meet in a node alone, each side gets its own node at
/// the same place; where they meet in an edge alone though they are connected around it, the smaller side is left out.
/// Nodes without tetrahedra are dropped. After that every edge of the outer faces has exactly two of them.
void separate(TetrahedralMesh& mesh);

/// The components connected through faces, largest volume first.
struct TetrahedralComponents {
    std::vector<std::uint32_t> component_of;  ///< for each tetrahedron
    std::vector<double> volumes;              ///< m³
};
TetrahedralComponents find_components(const TetrahedralMesh& mesh);

/// Keeps the first `count` components, drops the nodes of the others.
void keep_components(TetrahedralMesh& mesh, TetrahedralComponents& components, std::size_t count);

/// Sets `surface` and `surface_tetrahedra`.
void find_surface(TetrahedralMesh& mesh);

}  // namespace embody::geometry
