// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/tetrahedra/enclosed_solid.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"

namespace embody::geometry {

/// Nodes of the lattice that covers `box` with cubes of the side `cell` (m) and one more all around.
double count_lattice_nodes(const Bounds& box, double cell);

/// Fills the solid from a body-centred cubic lattice with cubes of the side `cell` (m), by isosurface stuffing
/// (F. Labelle, J. R. Shewchuk, ACM Trans. on Graphics 26(3), 2007). The result has neither surface nor separated
/// parts yet: tetrahedra may touch at an edge or a node alone. No tetrahedra where the lattice misses the solid.
TetrahedralMesh stuff(const EnclosedSolid& solid, double cell);

}  // namespace embody::geometry
