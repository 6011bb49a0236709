// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/stages/namespace.h"
#include "physics/state/world_state.h"

namespace embody::physics::stages {

/// Where the ball that touches nothing but the still ground of these contacts ends the step, if it rolls or slides
/// along that ground all through it. False, and nothing told, where it lifts off, hits something, has come to rest or
/// moves on level ground. The surroundings are memory of the caller.
bool roll_ball(const WorldState& world, std::uint32_t body, std::span<const std::uint32_t> contacts,
               BallMemory::Surroundings& surroundings, RolledBall& rolled);

}  // namespace embody::physics::stages
