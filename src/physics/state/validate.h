// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

struct WorldState;

/// Checks what holds for a world's state after each step, whatever happens in it: numbers are finite, rotations have
/// length one, lists are sorted and name existing elements, sleepers are in exactly one group, islands are disjoint,
/// the broad phase holds all pairs that may collide. Returns the first error: `where` is the element, e.g.
/// "bodies[3].rotation". Between steps users make changes that the next step takes in. It visits everything:
/// EMBODY_VALIDATE.
Result<void> validate(const WorldState& world);

}  // namespace embody::physics::state
