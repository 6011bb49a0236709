// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>

#include "geometry/tetrahedra/tetrahedral_mesh.h"

namespace embody::geometry {

/// The number of tetrahedra of a grid of so many cells.
std::size_t grid_tetrahedra(std::array<int, 3> cells);

/// Fills the image of the cube [-1, 1]³ under `place`, which is continuous and keeps the orientation. The cube is cut
/// into cells, at least one along each axis, with a node in the middle of each and of each outer face (F. Labelle, J.
/// R. Shewchuk, "Isosurface stuffing", 2007, but for the faces' nodes). So faces are mapped as faces, edges as edges:
/// nothing is cut off. Where `place` is linear, the mesh is its own mirror image in each axis.
TetrahedralMesh body_centred_grid(std::array<int, 3> cells, const std::function<Vec3(Vec3)>& place);

}  // namespace embody::geometry
