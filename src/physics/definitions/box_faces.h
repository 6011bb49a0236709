// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "math/vec3.h"

namespace embody::physics {

/// Corners of the box about the origin: bits 0, 1, 2 of the number say whether x, y, z are positive.
inline std::array<Vec3, 8> box_corners(Vec3 half_extents) {
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        corners[i] = {(i & 1) != 0 ? half_extents.x : -half_extents.x, (i & 2) != 0 ? half_extents.y : -half_extents.y,
                      (i & 4) != 0 ? half_extents.z : -half_extents.z};
    }
    return corners;
}

/// Its faces -x, x, -y, y, -z, z: corners counter-clockwise seen from outside.
inline constexpr std::array<std::array<std::uint32_t, 4>, 6> box_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

}  // namespace embody::physics
