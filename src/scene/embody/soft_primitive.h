// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "catalog/soft_mesh.h"
#include "foundation/result.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// The tetrahedra of a box, sphere, cylinder or capsule: cells that fit its faces, with the shape's volume
/// (docs/physics/ deformables.md: Meshes of primitives). `resolution`: cells across its smallest extent; 0: as many as
/// bend rightly at little cost. Nothing for other shapes. Errors: it takes too many tetrahedra.
std::optional<Result<catalog::SoftMesh>> soft_primitive(const physics::ShapeDefinition& shape, int resolution);

}  // namespace embody::scene
