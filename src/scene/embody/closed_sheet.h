// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "attributes/to_physics.h"
#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// The surface of a sphere or box in about `nodes` nodes, for gas inside. Nothing for other shapes.
std::optional<attributes::SheetMesh> closed_sheet_of(const physics::ShapeDefinition& shape, int nodes);

/// The surface of what is filled with tetrahedra, counter-clockwise from outside.
attributes::SheetMesh closed_sheet_of(const geometry::TetrahedralMesh& filling);

/// Whether each edge of the sheet has two triangles.
bool is_closed(const attributes::SheetMesh& sheet);

}  // namespace embody::scene
