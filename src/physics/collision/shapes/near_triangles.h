// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

class TriangleSurface;

/// A triangle of a surface within reach of a point, in the surface's frame.
struct NearTriangle {
    std::uint32_t index = 0;
    std::array<Vec3, 3> corners;
    Vec3 away;  ///< from its nearest point to the point, in the precision of floats
};

/// Appends those of `triangles` that may be closer to `point` than `reach`, m, in their order. None that is closer is
/// left out.
void find_near_triangles(const TriangleSurface& surface, std::span<const std::uint32_t> triangles, Vec3 point,
                         double reach, std::vector<NearTriangle>& found);

}  // namespace embody::physics::collision
