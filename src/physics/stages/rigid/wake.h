// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/stages/namespace.h"
#include "physics/state/world_state.h"

namespace embody::physics::stages {

/// Wakes the sleeping group of a body, if it sleeps; its contacts serve as warm start of the next step.
void wake_group_of(WorldState& world, std::uint32_t body);

/// Lists the bodies that move and takes their forces from what they were told.
void gather_awake(WorldState& world);

/// Asks for the group of a body (by its slot) to be awake in the next step.
void wake_later(WorldState& world, std::uint32_t body);

/// Asks for everything that touches the body and itself to be awake in the next step.
void wake_touching(WorldState& world, std::uint32_t body);

/// Asks for everything that touches the body, its jointed partners and itself to be awake in the next step.
void wake_around(WorldState& world, std::uint32_t body);
void wake_around(WorldState& world, std::span<const std::uint32_t> bodies);

/// By slot, whether it is one of these.
std::vector<bool> marked(const WorldState& world, std::span<const std::uint32_t> bodies);

}  // namespace embody::physics::stages
