// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "benches/race/engine.h"

namespace embody::race {

/// Penetration depths, by the true shapes and by the same code for every engine.
struct Overlap {
    double bodies = 0;   ///< deepest penetration of two bodies, m
    double statics = 0;  ///< deepest penetration of a body into the ground, a wall or the terrain, m
    int escaped = 0;     ///< bodies whose centre is below the ground, outside the pen, or not a number
};

/// `bodies`: including those that events added.
Overlap measure_overlap(const RaceScene& scene, std::span<const RaceBody> bodies, std::span<const BodyState> states);

}  // namespace embody::race
