// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

/// Whether neither the cell of a place nor those beside it are liquid: a particle there is a drop by itself.
bool is_drop(const FluidGrid& grid, const float* place);

/// The drops' surroundings and the length of the step, s.
struct DropSurroundings {
    const FluidGrid& grid;
    const FluidObstacles& obstacles;
    const FluidDropSettings& settings;
    double dt = 0;
};

/// Reduces the velocity (m/s) of a drop of a liquid at `place` by the friction of a wall beside it
/// (docs/physics/fluids.md, "Drops").
void slow_at_wall(const DropSurroundings& around, const FluidProperties& liquid, const float* place, float* velocity);

}  // namespace embody::physics::fluid
