// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

/// Wakes the sleeping group of a body, if it sleeps; its contacts serve as warm start of the next step.
void wake_group_of(const WakeAccess& world, std::uint32_t body);

/// Lists the bodies that move and takes their forces from those that users set.
void gather_awake(const WakeAccess& world);

/// Asks for the group of a body (by its slot) to be awake in the next step.
void wake_later(ActivityState& activity, std::uint32_t body);

/// Asks for everything that touches the body and itself to be awake in the next step.
void wake_touching(const WakeAccess& world, std::uint32_t body);

/// Asks for everything that touches the body, its jointed partners and itself to be awake in the next step.
void wake_around(const WakeAccess& world, std::uint32_t body);
void wake_around(const WakeAccess& world, std::span<const std::uint32_t> bodies);

/// By slot: whether the body is one of these.
std::vector<bool> marked(const RigidState& rigid, std::span<const std::uint32_t> bodies);

}  // namespace embody::physics::stages
