// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/step_report.h"
#include "physics/dynamic/body_state.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

/// T = ½ m v² + ½ ω·Iω (paper, III.A), J.
double kinetic_energy(const BodyState& state, const BodyConstants& constants);

/// Angular momentum about the centre of mass between steps, world, kg m²/s.
Vec3 spin_momentum(const BodyState& state, const BodyConstants& constants);

/// Adds one body's energies and momenta; `gravity` with the body's gravity factor applied, m/s².
void add_conserved(Conserved& sum, const BodyState& state, const BodyConstants& constants, Vec3 gravity);

}  // namespace embody::physics::dynamic
