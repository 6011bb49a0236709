// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"

namespace embody::physics::fluid {

struct FluidProperties;

/// Whether neither the cell of a place nor those beside it are liquid: a particle there is a drop by itself.
bool is_drop(const FluidGrid& grid, const float* place);

/// The drops' surroundings, their liquid, and the length of the step, s.
struct DropSurroundings {
    const FluidGrid& grid;
    const FluidObstacles& obstacles;
    const FluidProperties& liquid;
    const FluidDropSettings& settings;
    double dt = 0;
};

/// Reduces the velocity (m/s) of a drop at `place` by the friction of a wall beside it (docs/physics/fluids.md,
/// "Drops").
void slow_at_wall(const DropSurroundings& around, const float* place, float* velocity);

}  // namespace embody::physics::fluid
