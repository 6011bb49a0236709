// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/matter/moving_points.h"

namespace embody::scene {

/// A note on a liquid with this initial state if it is thinner than its particles; else empty.
std::string note_of(const LiquidDefinition& liquid, const MovingPoints& points);

/// Whether two liquids of different fluids, which do not interact, overlap.
bool are_overlapping(const MovingPoints& a, const MovingPoints& b);

}  // namespace embody::scene
