// SPDX-License-Identifier: MIT
#pragma once

#include "physics/optimization/islands.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Moves each ball that touches only ground that stands still and other such balls, and that rolls or slides on ground
/// that is not level, along that ground through the whole step; the motion is kept aside for take_rolled_balls(). Its
/// contacts are no impacts any more: the collisions of such balls are solved along the path. The contact solver keeps a
/// plane fixed for a step, and lifting the ball out of the curved ground adds g dt / 2R of its energy a second.
void roll_balls(const RollAccess& world);

/// Whether the island is balls that were rolled; they are then at their places at the step's end.
bool take_rolled_balls(const SubstepAccess& world, const Island& island);

/// Whether the body is where it was rolled to in this step, with `ground` among what it rolled along.
bool has_rolled_along(const ContinuousAccess& world, std::uint32_t body, std::uint32_t ground);

}  // namespace embody::physics::stages
