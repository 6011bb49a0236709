// SPDX-License-Identifier: MIT
#pragma once

#include "physics/step/world_state.h"

namespace embody::physics {

/// Adds to the bodies of the present impact (ImpactMemory::bodies) those that joints connect with them, at most
/// `most_jointed_bodies` and as many joints as a direct solve takes, the fewest joints away first; lists them and their
/// joints (jointed, jointed_joints). Farther ones learn of the impact from the substeps.
void gather_jointed(WorldState& world);

inline constexpr std::size_t most_jointed_bodies = 64;

/// Whether the jointed bodies of the present impact can be flown as the substeps will move them: few, all of what
/// joints connect, carried by nothing, without motors and limits, which have no way back.
bool can_fly_jointed(const WorldState& world);
/// Moves them through `time`, s, also back (negative).
void fly_jointed(WorldState& world, double time);

}  // namespace embody::physics
