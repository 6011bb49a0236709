// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/namespace.h"
#include "physics/state/world_state.h"

namespace embody::physics::stages {

/// Takes each ball that touches nothing but ground that stands still, and rolls or slides on it where it is not level,
/// along that ground through the whole step; the motion is kept aside for take_rolled_ball(). Its contacts are no
/// impacts any more. The contact solver holds a plane fast for a step and lifts the ball out of the curved ground for
/// nothing, g dt / 2R of its energy a second.
void roll_balls(WorldState& world);

/// Whether the island is a ball that was rolled; it is then where the step takes it.
bool take_rolled_ball(WorldState& world, const Island& island);

}  // namespace embody::physics::stages
