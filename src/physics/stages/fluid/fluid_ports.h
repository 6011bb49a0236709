// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Before the fluids advance: drains take particles, then sources add those of the last step.
void run_fluid_ports(const FluidAccess& world);

}  // namespace embody::physics::stages
