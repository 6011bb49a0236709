// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// How many parts a step of a fluid is solved in (src/physics/fluid/solver.cpp).
struct FluidPartSettings {
    /// Maximum travel of particles in a part of a step, and of obstacles where the liquid catches up with them, cells.
    /// Source: below the two cells around an obstacle within which distances to it are known. N. Foster, R. Fedkiw,
    /// "Practical animation of liquids", 2001, allow 5. Test: Settings.AreNoticed.
    double max_displacement = 1.5;
    /// Maximum number of parts of a step; faster liquid is slowed and the report says so. Test: Settings.AreNoticed.
    int max_parts = 16;
    /// One particle in this many may be faster than the usual speed, which determines the parts of a step and sleep: a
    /// few fast drops do not make the whole fluid take more parts. Test: Settings.AreNoticed.
    std::size_t particles_per_outlier = 200;
};

template <>
inline constexpr auto settings_of<FluidPartSettings> = std::tuple{
    Setting{"max_displacement", &FluidPartSettings::max_displacement, 0.01, 4, "cells"},
    Setting{"max_parts", &FluidPartSettings::max_parts, 1, 1000},
    Setting{"particles_per_outlier", &FluidPartSettings::particles_per_outlier, 1, 1e9},
};
static_assert(setting_count<FluidPartSettings> == member_count<FluidPartSettings>(), "a setting is in no list");

/// Which cells are worked on and which hold liquid (src/physics/fluid/grid).
struct FluidCellSettings {
    /// Fraction of a cell's kernel outside obstacles, 0 … 1, below which the cell takes its surface from its
    /// neighbours. Test: Settings.AreNoticed.
    float min_room = 0.3f;
    /// Number of times that cells with less room look at such neighbours: with two, cells in corners are reached. Test:
    /// Settings.AreNoticed.
    int narrow_passes = 2;
    /// Number of particles in a tile of 128 cells from which on the tile counts as liquid without a closer look.
    /// Source: one and a half a cell; liquid has eight. Test: Settings.AreNoticed.
    std::uint32_t full_tile_particles = 192;
    /// Filled fraction of a cell's room from which on the cell may soon be liquid. Source: liquid cells are half full
    /// (height_of_surface in liquid_cells.cpp), and a part of a step moves cells that are nearly so. Test:
    /// Settings.AreNoticed.
    float wet_fraction = 0.45f;
    /// Maximum number of such cells in a tile that still count as a few drops beside each other. Test:
    /// Settings.AreNoticed.
    int max_drop_cells = 2;
    /// Filled fraction of a cell's room from which on the cell is no drop even if it is alone. Test:
    /// Settings.AreNoticed.
    float full_fraction = 0.9f;
    /// Maximum cells of the grid's box for each particle; stray particles that would need more are removed. Source: a
    /// cell takes some 110 bytes, so many of them 1.7 kB a particle. Test: Settings.AreNoticed.
    std::size_t box_cells_per_particle = 16;
    /// Cells that the box may always have, however few particles there are. Source: 0.2 GB at 110 bytes a cell. Test:
    /// Settings.AreNoticed.
    std::size_t min_box_cells = 2'000'000;
};

template <>
inline constexpr auto settings_of<FluidCellSettings> = std::tuple{
    Setting{"min_room", &FluidCellSettings::min_room, 0.01, 1},
    Setting{"narrow_passes", &FluidCellSettings::narrow_passes, 0, 100},
    Setting{"full_tile_particles", &FluidCellSettings::full_tile_particles, 1, 1e6},
    Setting{"wet_fraction", &FluidCellSettings::wet_fraction, 0, 1},
    Setting{"max_drop_cells", &FluidCellSettings::max_drop_cells, 0, 128},
    Setting{"full_fraction", &FluidCellSettings::full_fraction, 0, 100},
    Setting{"box_cells_per_particle", &FluidCellSettings::box_cells_per_particle, 1, 100},
    Setting{"min_box_cells", &FluidCellSettings::min_box_cells, 1e5, 2e7},
};
static_assert(setting_count<FluidCellSettings> == member_count<FluidCellSettings>(), "a setting is in no list");

}  // namespace embody::physics
