// SPDX-License-Identifier: MIT
#pragma once

#include "validation/golden_scenes.h"

namespace embody::physics {

// Scenes of setting_scenes() for settings of ConstraintSettings.

/// What is round and no ball: a cylinder that hardly tilts, a pair of wheels, a coin that nearly lies.
GoldenScene rolling_bodies();

/// Balls in shallow bowls: two that overlap and approach, a slow one, one that comes down, one that
/// goes round, one in the crease of the lowest place.
GoldenScene balls_in_bowls();

/// Low pyramids at rest, each an island of its own that is solved directly while it is slow.
GoldenScene small_pyramids();

/// A chain of more links than are solved at once, some of which spin, and a rotor that runs into its limit.
GoldenScene long_chain();

/// More balls that bounce off balls on the floor in one step than a step may have of such bounces.
GoldenScene many_bounces();

/// A chain that swings down to the floor with a load at its end.
GoldenScene loaded_chain();

}  // namespace embody::physics
