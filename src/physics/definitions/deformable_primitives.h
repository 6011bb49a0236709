// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "physics/definitions/deformable_definition.h"

namespace embody::physics {

// Meshes of simple sheets, lines and bricks. Sheets lie flat in the frame's XZ plane, centred, the warp along X. `edge`
// is the approximate length of the triangles' edges, m, > 0; where it is too coarse for the form, the mesh is made
// finer.

/// Rows of nearly equilateral triangles. Its four corners are nodes.
DeformableDefinition cloth_rectangle(double size_x, double size_z, double edge, Cloth cloth = {});

/// Rings of nearly equilateral triangles about a node in the middle (node 0).
DeformableDefinition cloth_disc(double radius, double edge, Cloth cloth = {});

/// A closed ball: the faces of an icosahedron, each split into equal triangles, on the sphere. It can hold gas.
DeformableDefinition cloth_ball(double radius, double edge, Cloth cloth = {});

/// A straight rope from `from` (node 0) to `to` (the last) in segments of equal length, `segment` or shorter.
DeformableDefinition rope_between(Vec3 from, Vec3 to, double segment, Rope rope = {});

/// A brick of `cells` bricks of six tetrahedra each, >= 1, its lower corner at the origin; the split is mirrored from
/// cell to cell, so that the whole has no handedness. The tetrahedra of `solid` are replaced.
DeformableDefinition tetrahedral_brick(Vec3 size, std::array<int, 3> cells, SoftSolid solid = {});

}  // namespace embody::physics
