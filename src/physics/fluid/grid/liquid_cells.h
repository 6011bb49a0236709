// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/definitions/settings/fluid_cell_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// The cells of liquid by row.
struct LiquidCells {
    std::vector<std::uint32_t> cells;
    std::vector<int> first_row;  ///< of each of the grid's active tiles, and how many rows there are
};

/// Marks the liquid's cells: grid.surface from the density and the room around, grid.row by number.
void mark_liquid(FluidGrid& grid, const FluidCellSettings& settings, LiquidCells& liquid, TaskPool& workers);

}  // namespace embody::physics::fluid
