// SPDX-License-Identifier: MIT
#pragma once

#include "physics/state/world_state.h"

namespace embody::physics {

/// Advances the world by one time step.
void step(WorldState& world);

}  // namespace embody::physics
