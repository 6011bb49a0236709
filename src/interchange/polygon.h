// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace embody::interchange {

/// Triangles of a polygon in space, as indices into its corners: it may be concave and need not be quite flat. n - 2
/// triangles of n corners, of the polygon's turn; none below 3. Of more than 1000 corners, a fan from the first one.
std::vector<std::array<std::uint32_t, 3>> triangles_of_polygon(std::span<const Vec3f> corners);

}  // namespace embody::interchange
