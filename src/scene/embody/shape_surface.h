// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "geometry/triangle_mesh.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// The surface of a valid shape as triangles, in its frame; round surfaces have 32 sides. Parts of a compound may
/// overlap. Errors: planes and heightfields, which have no inside.
Result<geometry::TriangleMesh> surface_of(const physics::ShapeDefinition& shape);

}  // namespace embody::scene
