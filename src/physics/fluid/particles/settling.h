// SPDX-License-Identifier: MIT
#pragma once

#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

/// Speed at which a sphere of a liquid's particle comes to move through liquid of another density, m/s.
/// `acceleration`: what acts on its excess of mass, m/s²; density, kg/m³, and viscosity, Pa s, of the liquid around.
double settling_speed(double density, double particle_volume, double acceleration, const Mixture::Around& around);

/// Adds to `shift` (m) how far a particle of a liquid that is dispersed in others settles in a part of a step of
/// length dt: the grid does not resolve drops smaller than its cells (docs/physics/fluids.md, "Several liquids").
/// `apparent_gravity`: gravity less the acceleration of the liquid around, m/s².
void settle(const FluidGrid& grid, const Mixture& liquids, std::size_t particle, const float* place,
            Vec3 apparent_gravity, double dt, float* shift);

}  // namespace embody::physics::fluid
