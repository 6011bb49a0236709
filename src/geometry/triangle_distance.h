// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "math/vec3.h"

namespace embody::geometry {

/// Square of the distance (m²) from `p` to the nearest point of the triangle; also right for one without area.
double squared_distance(Vec3 p, const std::array<Vec3, 3>& t);

}  // namespace embody::geometry
