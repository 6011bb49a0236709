// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/task_pool.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

/// Turbulent stress of a smooth wall over the density, m²/s², on liquid of kinematic viscosity ν (m²/s) that slides at
/// `speed` (m/s) along it at the distance y (m), beyond ν speed/y, the laminar one; 0 where that is all (docs/physics/
/// fluids.md, "Walls").
double turbulent_stress(double speed, double y, double kinematic_viscosity);

/// Slows the faces next to obstacles that liquid does not move by the layer at the wall, which is thinner than a cell,
/// and applies the reaction to the obstacles; small bodies that move freely have no such layer.
void apply_wall_friction(FluidGrid& grid, FluidObstacles& obstacles, const Mixture& liquids, double dt,
                         TaskPool& workers);

}  // namespace embody::physics::fluid
