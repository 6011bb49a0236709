// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "attributes/to_physics.h"
#include "foundation/result.h"
#include "geometry/triangle_mesh.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// The centre line of a thin long thing.
struct LineForm {
    std::vector<Vec3> nodes;  ///< along its middle, in its frame, m
    double diameter = 0;      ///< m
};

/// The middle plane of a thing that is thin along one axis of its frame: about `nodes` nodes where the thing fills the
/// rectangle of its other two extents; triangles outside of its outline are left out. Discs are made of rings. The
/// error says why it is no sheet.
Result<attributes::SheetMesh> sheet_of(const physics::ShapeDefinition& shape, int nodes);
Result<attributes::SheetMesh> sheet_of(const geometry::TriangleMesh& surface, int nodes);

/// A line along the longest axis of a thing that is thin across it, through the centre of its surface at each place,
/// with `segments` segments. Round shapes end at the centres of their end caps. The error says why it is no line.
Result<LineForm> line_of(const physics::ShapeDefinition& shape, int segments);
Result<LineForm> line_of(const geometry::TriangleMesh& surface, int segments);

}  // namespace embody::scene
