// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/step/namespace.h"

namespace embody::physics::step {

/// The last stage: contact events, counts and energies of the step. Commands for one step only are cleared.
void write_report(const ReportAccess& world);

}  // namespace embody::physics::step
