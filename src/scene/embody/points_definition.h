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

/// Places, size and matter of grains.
struct GrainDefinition {
    std::vector<Vec3> centers;     ///< in the entity's frame, m
    double diameter = 0.01;        ///< of a ball, m
    physics::BodyDefinition body;  ///< of each ball, without place and shape; pose and force are the entity's
};

/// A liquid that joins a fluid of finer cells has at most so many times its budget of particles: the largest ratio of
/// cell sizes cubed, rounded up.
inline constexpr std::size_t max_particles_ratio = 5;

/// The initial state of a body of liquid.
struct LiquidDefinition {
    physics::ShapeDefinition shape;          ///< the shape that it fills, without the bodies in it
    Transform pose;                          ///< of the shape
    physics::FluidDefinition matter;         ///< without volume and velocity
    std::vector<Vec3> places;                ///< of its particles in the shape's frame, of cells as large as the
                                             ///< matter's, m; empty: it fills the shape
    std::size_t particle_budget = 0;         ///< maximum number of particles
    double set_cell_size = 0;                ///< m, told by hand; 0: the cells of the matter come from the budget
    Vec3 linear_velocity, angular_velocity;  ///< m/s, rad/s, as of one rigid body
    Vec3 force;                              ///< constant, N, distributed over the particles
    bool starts_empty = false;               ///< its shape tells where taps will fill it
    bool enabled = true;
};

/// The points of an entity that is not one body.
using PointsDefinition = std::variant<GrainDefinition, LiquidDefinition, physics::DeformableDefinition>;

}  // namespace embody::scene
