// SPDX-License-Identifier: MIT
#pragma once

#include "physics/step/namespace.h"

namespace embody::physics::state {
struct WorldState;
}

namespace embody::physics::step {

/// Advances the world by one time step.
void step(WorldState& world);

}  // namespace embody::physics::step
