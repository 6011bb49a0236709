// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/bounds.h"

namespace embody::geometry {

/// Indexed triangles, counter-clockwise seen from outside. Metres.
struct TriangleMesh {
    std::vector<Vec3f> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Bounds bounds(const TriangleMesh& mesh);

}  // namespace embody::geometry
