// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "geometry/convex_hull.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// How well convex hulls represent a mesh, whatever made them.
struct DecompositionMeasure {
    /// m: from the surface of the hulls' union to the mesh, of all sampled places and at the 95th percentile; 0 where a
    /// place lies inside the mesh by its winding number. This is the volume that the hulls add.
    double added = 0, added_95 = 0;
    double left_out = 0;       ///< m: from the mesh to the nearest hull; what the hulls leave out
    double hull_volume = 0;    ///< m³, sum over the hulls: overlaps count twice
    std::size_t vertices = 0;  ///< of all hulls
};

/// Some `samples` places evenly over the hulls' surfaces, as many on the mesh. Needs exact distances, so it takes
/// longer than a decomposition.
DecompositionMeasure measure_decomposition(const TriangleMesh& mesh, std::span<const ConvexHull> hulls,
                                           int samples = 10000);

}  // namespace embody::geometry
