// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/deformable/contact/substep.h"
#include "physics/stages/deformable/thin_deformables.h"

namespace embody::physics::stages {

/// Before a substep of a rope: its contacts with round bodies get the planes of where they will be when it ends
/// (docs/physics/ropes.md, "On round bodies").
void follow_round_bodies(const Substep& substep, std::span<const TouchedBody> bodies, ThinDeformable& rope);

}  // namespace embody::physics::stages
