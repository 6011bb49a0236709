// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/definitions/shape_definition.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A point of a shape that may poke into a soft surface between its nodes, with the radius of the ball around it that
/// belongs to the shape, m.
struct BodyFeature {
    Vec3 point;  ///< in the shape's frame
    double radius = 0;
};

/// Corners, centres of balls, ends of capsules, points of rims. None of planes, heightfields and meshes: nodes touch
/// the faces of these.
std::vector<BodyFeature> find_features(const ShapeDefinition& shape);

}  // namespace embody::physics::deformable
