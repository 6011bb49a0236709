// SPDX-License-Identifier: MIT
#pragma once

#include <variant>
#include <vector>

#include "math/transform.h"
#include "physics/definitions/body_definition.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// What grains are filled in, and of what they are.
struct GrainDefinition {
    std::vector<Vec3> centers;     ///< in the entity's frame, m
    double diameter = 0.01;        ///< of a ball, m
    physics::BodyDefinition body;  ///< of each ball but for place and shape; pose and force are the entity's
};

/// A body of liquid as it begins.
struct LiquidDefinition {
    physics::ShapeDefinition shape;          ///< that it fills, less the bodies that stand in it
    Transform pose;                          ///< of the shape
    physics::FluidDefinition matter;         ///< neither volume nor velocity
    std::size_t particle_budget = 0;         ///< most particles
    Vec3 linear_velocity, angular_velocity;  ///< m/s, rad/s, as of one rigid thing
    Vec3 force;                              ///< constant, N, shared among the particles
    bool enabled = true;
};

/// What stands for an entity that is not one body.
using PointsDefinition = std::variant<GrainDefinition, LiquidDefinition, physics::DeformableDefinition>;

}  // namespace embody::scene
