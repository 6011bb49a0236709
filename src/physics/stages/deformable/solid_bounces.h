// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/stages/access.h"
#include "physics/state/deformable_state.h"

namespace embody::physics::stages {

/// After a substep of h seconds that ends `time` (s) after the step began: gives free solids the speed that their
/// material's restitution asks for, where they come back from what they hit (docs/physics/deformables.md, Bounce).
/// `records`: of the solids, which `contacts` count.
void bounce_solids(const DeformableAccess& world, std::span<DeformableRecord* const> records,
                   std::span<const SolidContact> contacts, std::span<TouchedBody> bodies, double h, double time);

}  // namespace embody::physics::stages
