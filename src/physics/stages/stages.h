// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/namespace.h"
#include "physics/state/world_state.h"

namespace embody::physics::stages {

// The stages of a step, in their order; each in the file of its name.
void wake_bodies(WorldState& world);
void advance_fluids(WorldState& world);
void find_pairs(WorldState& world);
void find_contacts(WorldState& world);
void solve_impacts(WorldState& world);
void list_active_joints(WorldState& world);
void find_islands(WorldState& world);
void run_substeps(WorldState& world);
void stop_tunnelling(WorldState& world);
void advance_deformables(WorldState& world);
void put_to_sleep(WorldState& world);
void settle_fluids(WorldState& world);

/// Slows awake bodies to the settings' greatest speeds; before a step, for what users did, and after its substeps.
void limit_speeds(WorldState& world);

}  // namespace embody::physics::stages
