// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "benches/race/engine.h"

namespace embody::race {

/// How deep things are in each other, by the true shapes and by the same code for every engine.
struct Overlap {
    double bodies = 0;   ///< deepest between two bodies, m
    double statics = 0;  ///< deepest of a body in the ground, a wall or the terrain, m
    int escaped = 0;     ///< bodies whose centre is below the ground or outside the pen, or is no number
};

/// `bodies` with those that events added.
Overlap measure_overlap(const RaceScene& scene, std::span<const RaceBody> bodies, std::span<const BodyState> states);

}  // namespace embody::race
