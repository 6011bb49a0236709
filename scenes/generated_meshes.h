// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/definitions/shape_definition.h"

namespace embody::scenes {

/// A closed surface of exactly 33,854 triangles, as many as the paper's dog has: body, head, snout, ears, four legs and
/// a tail as swellings of a sphere, with a seeded fur of millimetres. About 1 m long, standing on y = 0, head towards
/// +X.
physics::MeshShape make_dog(std::uint64_t seed);

/// Hills of 240 × 240 cells, the paper's 115,200 triangles, 120 m × 120 m around the origin of its frame's corner.
physics::HeightfieldShape make_terrain(std::uint64_t seed);

}  // namespace embody::scenes
