// SPDX-License-Identifier: MIT
#pragma once

#include "math/vec3.h"
#include "physics/inter/world.h"

namespace embody::scene {

/// A hand that holds a body at a point: a critically damped spring to a target.
struct Grab {
    physics::BodyHandle body;
    Vec3 local_point;  ///< in the body's frame
    Vec3 target;       ///< world
};

/// Pulls in the next step. Stable for any mass, lever arm and step: spring and damper use the effective mass of the
/// point and are evaluated at the step's end (implicit Euler).
void pull(physics::World& world, const Grab& grab);

}  // namespace embody::scene
