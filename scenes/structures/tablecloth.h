// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "physics/inter/world.h"

namespace embody::scenes {

/// A square cloth of 1.4 m that falls over a table of 0.9 m, beside stacks of boxes that stand on the floor.
struct TableclothScene {
    int edges = 10'000;  ///< of its mesh, about
    int boxes = 200;
    int workers = 1;
    double seconds = 5;
};

/// What that cost and how it ended.
struct TableclothCost {
    std::size_t nodes = 0, edges = 0;
    double fall_ms = 0;      ///< mean of a step while it falls and drapes (the first 2 s)
    double rest_ms = 0;      ///< mean of a step after that, nothing asleep
    double worst_ms = 0;     ///< slowest step
    double cloth_ms = 0;     ///< the share of the deformables in the mean of all steps
    std::uint64_t hash = 0;  ///< of the world's state at the end
    std::string wrong;       ///< what is not as it must be at the end; empty: right
};

/// Nothing sleeps, so that every step pays. Wrong where the cloth is in the table, slides in the last second, or does
/// not hang over the border as far as its size says, or a stack has fallen.
Result<TableclothCost> time_tablecloth(const TableclothScene& scene);

}  // namespace embody::scenes
