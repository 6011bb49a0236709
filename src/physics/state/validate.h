// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

struct WorldState;

/// What holds of a world's state after each step, whatever happens in it: numbers are finite, rotations have length
/// one, lists are sorted and name what there is, sleepers are in exactly one group, islands are disjoint, the broad
/// phase holds what may collide. The first of these that is broken: `where` is the element, e.g. "bodies[3].rotation".
/// Between steps users change what the next step brings in order. It walks through everything: EMBODY_VALIDATE.
Result<void> validate(const WorldState& world);

}  // namespace embody::physics::state
