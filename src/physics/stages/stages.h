// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

// The stages of a step, in their order; each in the file of its name.
void wake_bodies(const WakeAccess& world);
void advance_fluids(const FluidAccess& world);
void find_pairs(const PairsAccess& world);
void find_contacts(const TouchAccess& world);
void solve_impacts(const ImpactAccess& world);
void list_active_joints(const IslandAccess& world);
void find_islands(const IslandAccess& world);
void run_substeps(const SubstepAccess& world);
void stop_tunnelling(const ContinuousAccess& world);
void advance_deformables(const DeformableAccess& world);
void put_to_sleep(const SleepAccess& world);
void settle_fluids(const FluidAccess& world);
/// Before a step and after it: which brittle bodies its blows break, and into what. Broken bodies are replaced by the
/// face.
void note_motion(const FractureAccess& world);
void plan_breaks(const FractureAccess& world);

/// Slows awake bodies to the settings' greatest speeds.
void limit_speeds(const SpeedAccess& world);

}  // namespace embody::physics::stages
