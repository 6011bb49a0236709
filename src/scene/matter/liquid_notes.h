// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/matter/moving_points.h"

namespace embody::scene {

/// What is to be said of a liquid that was filled in as this: that it is thinner than its particles. Empty: nothing.
std::string note_of(const LiquidDefinition& liquid, const MovingPoints& points);

/// Whether two liquids of different fluids, which do not see each other, have a part of their space in common.
bool share_space(const MovingPoints& a, const MovingPoints& b);

}  // namespace embody::scene
