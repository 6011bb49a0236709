// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/inter/world.h"

namespace embody::scenes {

/// A heap that is poured on a rough plate from just above its top, as repose is measured.
struct HeapToPour {
    double friction_angle = 34;  ///< deg, physics::grain_material
    double diameter = 0.01;      ///< m
    int grains = 1500;
    std::uint64_t seed = 1;
    int workers = 1;
};

/// How it came to rest.
struct Heap {
    /// Slope of the cone with the grains' mean height H/4 and mean square distance 3R²/10 from the axis, degrees. No
    /// threshold says where the flank begins and ends; the outermost 3 % of the grains, which rolled off, are left out.
    double angle = 0;
    double overlap = 0;       ///< deepest of two grains, in diameters
    bool asleep = false;      ///< all but the grains that still roll on the plate, at most 1 in 100
    double rest_seconds = 0;  ///< from the last grain to that
};

/// Pours until all grains have fallen and steps until they rest, at most 10 s.
Result<Heap> pour_heap(const HeapToPour& definition);

/// Grains that fill a trench of 25 × 8 diameters with smooth side walls; then its end wall is drawn away at
/// 0.3 √(g d). The slope of the front that is left, degrees.
Result<double> draw_wall_away(const HeapToPour& definition);

/// A slab of grains, 20 diameters wide and as long, that collapses on a plate: milliseconds of a step over the first
/// second, when all move, and of one when all sleep.
struct SlabCost {
    double awake_ms = 0, asleep_ms = 0;
    std::size_t contacts = 0;  ///< most in a step
};
Result<SlabCost> time_slab(const HeapToPour& definition);

}  // namespace embody::scenes
