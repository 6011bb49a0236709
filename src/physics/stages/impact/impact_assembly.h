// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/impact_memory.h"

namespace embody::physics::stages {

/// Adds to the bodies of the present impact (ImpactMemory::bodies) those that joints connect with them, at most
/// ImpactBudgetSettings::max_jointed_bodies and at most as many joints as a direct solve takes, those the fewest joints
/// away first; lists them and their joints (jointed, jointed_joints). The substeps pass the impact on to farther
/// bodies.
void gather_jointed(const ImpactAccess& world);

/// Whether an active joint holds the body. Requires an earlier impact of jointed bodies in this step.
bool has_joints(const ImpactAccess& world, std::uint32_t body);

/// Whether the jointed bodies of the present impact can be moved as the substeps will move them: few, all that joints
/// connect, carried by nothing, without motors and limits, which are not reversible.
bool can_fly_jointed(const ImpactAccess& world);
/// Moves them from the step's start to `time`, s; from there back to the start if the time is negative.
void fly_jointed(const ImpactAccess& world, double time);

/// Puts kinematic bodies that have joints of the present impact to their places at `time`, s since the step began.
void move_carriers(const ImpactAccess& world, double time);
/// Puts them back to where they are at the step's start.
void put_carriers_back(const ImpactAccess& world);

}  // namespace embody::physics::stages
