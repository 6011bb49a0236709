// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/ball_memory.h"

namespace embody::physics::stages {

/// Moves balls that roll on still ground close to each other through the step, together with their collisions: the
/// members (indices of candidates) and their pairs, of world.balls. False where one of them cannot be followed so; then
/// there is no result but the limit, where their collisions do not end.
bool roll_cluster(const RollAccess& world, std::span<const std::uint32_t> members, std::span<BallMemory::Pair> pairs);

}  // namespace embody::physics::stages
