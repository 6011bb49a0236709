// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/placed_triangle.h"

#include <algorithm>

namespace embody::physics::collision {

bool PlacedTriangle::leans_too_far(Vec3 outwards, Vec3 at) const {
    constexpr double on_edge = 1e-4;  // in shares of the edge's length
    const double up = dot(outwards, normal);
    if (up <= 0) return true;
    for (std::size_t i = 0; i < 3; ++i) {
        if (beyond(i, at) < -on_edge * length(along(i))) continue;
        const double over = dot(outwards, outward[i]), half = static_cast<double>(half_dihedrals[i]);
        if (over <= flat_sine || std::isinf(half)) continue;
        // Angle of lean against angle of bend: positive sine of their difference is too far. All is multiplied by
        // 1 + half², for sine and cosine of the bend.
        if (over * (1 - half * half) - up * 2 * half > flat_sine * (1 + half * half)) return true;
    }
    return false;
}

bool PlacedTriangle::is_flat_to(Vec3 outwards) const { return dot(outwards, normal) > 1 - flat_sine * flat_sine; }

bool PlacedTriangle::normal_is_best() const {
    const double depth = std::max(0.0, -height);
    for (std::size_t i = 0; i < 3; ++i) {
        // Leaning over the edge by an angle v lowers the gap by |x| sin v and raises it by at most depth (1 - cos v).
        if (is_open(i) && beyond(i, lowest) > -depth) return false;
    }
    return true;
}

Vec3 PlacedTriangle::nearest_to(Vec3 p) const {
    if (beyond(0, p) <= 0 && beyond(1, p) <= 0 && beyond(2, p) <= 0) return p - normal * dot(p - corners[0], normal);
    Vec3 nearest;
    double least = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 u = corners[i], travel = along(i);
        const Vec3 on_edge = u + travel * std::clamp(dot(p - u, travel) / length_squared(travel), 0.0, 1.0);
        const double squared = length_squared(on_edge - p);
        if (squared >= least) continue;
        least = squared;
        nearest = on_edge;
    }
    return nearest;
}

}  // namespace embody::physics::collision
