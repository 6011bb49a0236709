// SPDX-License-Identifier: MIT
#pragma once

#include <variant>
#include <vector>

#include "math/vec3.h"
#include "physics/inter/definitions/body_definition.h"
#include "physics/inter/definitions/deformable_definition.h"

namespace embody::scene {

/// What grains are filled in, and of what they are.
struct GrainDefinition {
    std::vector<Vec3> centers;     ///< in the entity's frame, m
    double diameter = 0.01;        ///< of a ball, m
    physics::BodyDefinition body;  ///< of each ball but for place and shape; its pose is the entity's
};

/// What stands for an entity that is not one body.
using PointsDefinition = std::variant<GrainDefinition, physics::DeformableDefinition>;

}  // namespace embody::scene
