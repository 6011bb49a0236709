// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>

#include "geometry/decomposition/search_hull.h"
#include "geometry/decomposition/solid_grid.h"

namespace embody::geometry {

/// Settings of all parts of one decomposition.
struct DecompositionSearch {
    const SolidGrid& grid;
    double error;       ///< m, concavity that is accepted
    double tolerance;   ///< m, of search hulls
    double thickness;   ///< m, minimum of search hulls: those of sheets must contain places of the grid
    double void_depth;  ///< m, places less deep are ignored
};

/// A piece of the surface, clipped by the planes that made it, and its hull.
struct Part {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    SearchHull hull;
    std::vector<Void> voids;  ///< all those in the hull
    double concavity = 0;     ///< m, depth of the deepest
    bool is_final = false;    ///< no plane improves it
};

/// Sets hull, voids (those of `candidates` in the hull) and concavity from the points.
void complete(Part& part, std::span<const Void> candidates, const DecompositionSearch& search);

/// The two sides of the plane, complete; none where one side would be empty.
std::optional<std::pair<Part, Part>> cut(const Part& part, const CutPlane& plane, const DecompositionSearch& search);

/// The plane that leaves the least hollow in the hulls of both sides; none where no plane helps.
std::optional<CutPlane> choose_cut(const Part& part, const DecompositionSearch& search);

/// Merges pairs, least concavity first, while that stays within the error, and on until at most `max_parts` are left.
/// Merged parts keep only points and hull.
void merge_parts(std::vector<Part>& parts, std::size_t max_parts, const DecompositionSearch& search);

}  // namespace embody::geometry
