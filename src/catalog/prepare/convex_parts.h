// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "geometry/triangle_mesh.h"

namespace embody::catalog {

/// The convex decomposition of a model, and its settings.
struct ConvexParts {
    int max_hulls = 0;
    double hull_error = 0;                  ///< m
    double concavity = 0;                   ///< m, deepest hollow that a hull still fills
    double hull_concavity = 0;              ///< m, of the single hull of all
    std::vector<std::vector<Vec3f>> hulls;  ///< vertices of each, largest hull first, model frame
};

inline constexpr std::size_t max_part_vertices = 64;  ///< of one hull of a decomposition

/// Decomposes; the hull of all is left whole where its concavity is at most `keep_below` (m). Errors as of
/// geometry::decompose.
Result<ConvexParts> make_convex_parts(const geometry::TriangleMesh& mesh, int max_hulls, double hull_error,
                                      double keep_below = 0);

/// The hulls for the database: a count, then for each hull its count of vertices and their x y z; little-endian 32-bit
/// integers and floats.
std::vector<std::uint8_t> pack_hulls(const std::vector<std::vector<Vec3f>>& hulls);
Result<std::vector<std::vector<Vec3f>>> unpack_hulls(std::span<const std::uint8_t> bytes);

}  // namespace embody::catalog
