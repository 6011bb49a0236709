// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "foundation/result.h"
#include "geometry/convex_hull.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

inline constexpr int max_decomposition_hulls = 256;
inline constexpr double min_hull_error = 1e-4;  ///< m

struct DecompositionParameters {
    int max_hulls = 16;        ///< 1 … 256; the error is exceeded where that is too few
    double hull_error = 0.01;  ///< m, concavity that may stay: at least 1e-4
    int max_vertices = 64;     ///< of each hull, 8 … 256
    int cells = 131072;        ///< of the grid that says what is outside, 4096 … 2^24
    double keep_below = 0;     ///< m: the hull of all stays whole where its concavity is no more than this
    bool open_below = false;   ///< whether a hollow open only downwards counts as one, and is not filled
    /// Called now and then with the fraction that is done, 0 … 1; false stops with an error. May be empty.
    std::function<bool(double share)> progress = {};
};

struct Decomposition {
    std::vector<ConvexHull> hulls;  ///< largest volume first; together they contain the mesh within the error
    std::vector<double> depths;     ///< m, concavity of each
    double concavity = 0;           ///< m, the largest of them
    double hull_concavity = 0;      ///< m, of the single hull of all
    double cell = 0;                ///< m, of the grid: hollows narrower than this are not found
};

/// A few convex hulls that represent the volume bounded by the triangles, which need not be closed, consistent or
/// manifold.
/// The concavity of a hull is the largest distance from a place in it that other bodies can reach (see SolidGrid)
/// to the surface. Connected parts are hulls to begin with; those too deep are cut by planes, deepest first; then hulls
/// whose common hull is within the error are merged, and more until max_hulls. A sheet gets a thickness of 2 mm or half
/// the error. Same mesh and parameters, same hulls; bounded time and memory. Errors: a parameter out of its range,
/// invalid indices or numbers, no triangles, extents beyond 1e5 m, stopped by `progress`.
Result<Decomposition> decompose(const TriangleMesh& mesh, const DecompositionParameters& parameters = {});

/// The concavity of the convex hull alone, as above: 0 where the mesh is convex.
Result<double> measure_hull_concavity(const TriangleMesh& mesh, const DecompositionParameters& parameters = {});

}  // namespace embody::geometry
