// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "foundation/result.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// Centres of balls of this diameter (m) that fill a shape as loosely as poured grains, in the shape's frame, from the
/// lowest layer upwards, at most `max_count`. The same seed gives the same places. The error says why none fits, or
/// that more than 1.5 times `max_count` would fit.
Result<std::vector<Vec3>> fill_with_grains(const physics::ShapeDefinition& shape, double diameter,
                                           std::size_t max_count, std::uint64_t seed);

}  // namespace embody::scene
