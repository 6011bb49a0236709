// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/matter/fluid_body.h"

namespace embody::scene {

/// A note on a liquid with this initial state if it is thinner than its particles, or if its cells are not those that
/// were told by hand; else empty.
std::string note_of(const LiquidDefinition& liquid, const FluidBody& body);

/// Whether two liquids of different fluids, which do not interact, overlap.
bool are_overlapping(const MovingPoints& a, const MovingPoints& b);

}  // namespace embody::scene
