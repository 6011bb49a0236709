// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "math/vec3.h"

namespace embody::geometry {

/// Mean of the points; zero without any. The mean of a convex solid's corners lies inside.
inline Vec3 mean_point(std::span<const Vec3> points) {
    Vec3 mean;
    for (const Vec3& point : points) mean += point / static_cast<double>(points.size());
    return mean;
}

}  // namespace embody::geometry
