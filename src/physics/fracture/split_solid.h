// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/random.h"
#include "physics/fracture/convex_cell.h"
#include "physics/fracture/namespace.h"

namespace embody::physics::fracture {

/// A connected part of the solid in the Voronoi cell of one seed.
struct Piece {
    std::vector<std::vector<Vec3>> hulls;  ///< corners of its convex solids, each a hull by itself; never empty
    geometry::MassProperties solid;        ///< of all of it, at density 1
    Bounds bounds;
};

struct Split {
    std::vector<Piece> pieces;
    double crack_area = 0;  ///< m²: of the surfaces between pieces, each counted once
};

/// Cuts convex solids along the Voronoi cells of the seeds. The pieces are disjoint, and their mass properties add up
/// to those of the solids: what is too thin for a hull of its own is carried by the nearest piece. Solids that overlap
/// both count. `min_piece_volume`: of a piece, m³; smaller ones are carried, too. Equal inputs give equal bits.
Split split_solid(std::span<const ConvexCell> solids, std::span<const Vec3> seeds, double min_piece_volume = 0);

/// Seeds of `count` cells, every second one drawn towards `impact`: there the pieces are smaller.
std::vector<Vec3> choose_seeds(std::span<const ConvexCell> solids, Vec3 impact, int count, Random& random);

}  // namespace embody::physics::fracture
