// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "physics/constraint/rolling/ball_path.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// The path of a ball along the still ground of these contacts; the grounds are listed in `surroundings`.
BallPath path_of_ball(const RollAccess& world, std::uint32_t body, std::span<const std::uint32_t> contacts,
                      BallSurroundings& surroundings);

}  // namespace embody::physics::stages
