// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// The mesh with vertices closer than `tolerance` (m, 0 = equal only) made one: each vertex goes to the first kept one
/// within it. Triangles that lose a side, and copies of a triangle (also turned around, as double-sided surfaces have
/// them), are dropped; vertices without triangles too. Same mesh, same result.
TriangleMesh weld(const TriangleMesh& mesh, double tolerance);

/// How the triangles of a welded mesh are connected.
struct Topology {
    std::size_t edge_count = 0;
    std::size_t boundary_edges = 0;      ///< with one triangle
    std::size_t crowded_edges = 0;       ///< with more than two
    std::size_t inconsistent_edges = 0;  ///< two triangles that run it in the same direction
    std::uint32_t component_count = 0;
    std::vector<std::uint32_t> component_of;  ///< for each triangle, numbered in order of first triangle

    /// Every edge is used exactly twice, in opposite directions: the mesh bounds a volume.
    [[nodiscard]] bool is_closed() const {
        return edge_count > 0 && boundary_edges == 0 && crowded_edges == 0 && inconsistent_edges == 0;
    }
};
/// Components are triangles connected through common edges. Vertices are common if their indices are equal: weld()
/// first.
Topology find_topology(const TriangleMesh& mesh);

/// Whether the mesh is closed once vertices within 1e-6 of its size are welded.
bool is_closed(const TriangleMesh& mesh);

/// Turns triangles so that neighbours agree and each connected patch faces outwards (has a positive volume, seen from
/// the middle of its bounds, if it is open). Patches end at edges with more than two triangles. Where a patch cannot
/// agree (a Möbius strip) some edges stay inconsistent.
TriangleMesh oriented_outwards(const TriangleMesh& mesh);

/// One mesh for each component, in order.
std::vector<TriangleMesh> split_components(const TriangleMesh& mesh, const Topology& topology);

}  // namespace embody::geometry
