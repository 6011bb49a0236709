// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

class FluidGrid;
struct MovingObstacle;

/// A shut face of an obstacle that fills only a part of its control volume, the rest of which moves with the obstacle.
struct BoundFace {
    int axis = 0, cell = 0;
    float fraction = 0;  ///< of the control volume that is shut but outside the obstacle
    double mass = 0;     ///< of liquid in it, kg
    Vec3 turn;           ///< (place − the obstacle's centre of mass) × axis, m
    double speed = 0;    ///< of that liquid along the axis before it is bound, m/s
};

/// Response of a body's velocities to impulses: its inverse mass and inertia, with the liquid that it has bound.
struct ObstacleResponse {
    Mat3 linear = Mat3::zero(), coupling = Mat3::zero(), angular = Mat3::zero();

    [[nodiscard]] Vec3 linear_change(Vec3 impulse, Vec3 moment) const { return linear * impulse + coupling * moment; }
    [[nodiscard]] Vec3 angular_change(Vec3 impulse, Vec3 moment) const {
        return transpose(coupling) * impulse + angular * moment;
    }
};

/// Finds the liquid at a moving obstacle's bound faces by the last pressure, its speed, and the obstacle's response.
/// The obstacle takes over the liquid's momentum: its velocities become the common ones. `density`: of the first
/// liquid.
void bind_liquid(const FluidGrid& grid, double density, Vec3 gravity, MovingObstacle& moving);

/// Applies the change of the liquid's momentum to the obstacle, once both have their final velocity.
void release_liquid(MovingObstacle& moving);

}  // namespace embody::physics::fluid
