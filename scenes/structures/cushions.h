// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "physics/inter/world.h"

namespace embody::scenes {

/// Two cushions that fall on each other, a box that falls on both, and a block of foam that bears a box from the start,
/// beside stacks of boxes.
struct CushionScene {
    int cells = 10;  ///< of a cushion's mesh along each side, >= 2: 10 makes 4,968 tetrahedra in all
    int boxes = 200;
    int workers = 1;
    double seconds = 5;
};

/// What that cost and how it ended.
struct CushionCost {
    std::size_t nodes = 0, tetrahedra = 0;
    double fall_ms = 0;      ///< mean of a step of the first 2 s, in which all lands and comes to rest
    double rest_ms = 0;      ///< mean of a step after that, nothing asleep
    double worst_ms = 0;     ///< slowest step
    double solids_ms = 0;    ///< the share of the deformables in the mean of all steps
    double compression = 0;  ///< of the block of foam, over what its weights make of it by calculation
    std::uint64_t hash = 0;  ///< of the world's state at the end
    std::string wrong;       ///< what is not as it must be; empty: right
};

/// Nothing sleeps, so that every step pays. Wrong where the foam's compression is off by 2 %, the energy of all grows
/// above that of the start, cushions or the box on them still move in the end or have gone through each other or the
/// floor, or a stack has fallen.
Result<CushionCost> time_cushions(const CushionScene& scene);

}  // namespace embody::scenes
