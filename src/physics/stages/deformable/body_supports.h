// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/solid/solid_contact.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_deformables.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Sets what bears each body, as the rigid stages of this step found it: contacts with, and joints to, what does not
/// give way: the world, static and kinematic bodies, sleepers. `bodies`: ascending by slot. Only of those that sheets
/// and solids may push, or have pushed in the last step: ropes alone take bodies as free (docs/physics/coupling.md).
void find_supports(const DeformableAccess& world, std::span<const SolidContact> of_solids,
                   std::span<const ThinDeformable> thin, std::span<TouchedBody> bodies);

}  // namespace embody::physics::stages
