// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "math/mat3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

struct RopeSegment {
    double length = 0;  ///< at rest, m
    bool is_broken = false;
};

/// Direction of a segment, and its derivative by the place of its end (by that of its start: the opposite).
struct SegmentDirection {
    Vec3 displacement;  ///< unit, shorter where the segment has next to no length
    Mat3 by_end;        ///< 1/m
};
inline SegmentDirection direction_of(Vec3 edge, double rest_length) {
    // Of the length at rest: keeps the derivative finite where the segment is compressed to a point.
    constexpr double min_fraction = 0.01;
    const double l = std::max(length(edge), min_fraction * rest_length);
    const Vec3 t = edge / l;
    return {t, (1 / l) * (Mat3::identity() - outer(t, t))};
}

/// Of M. Bergou and others, "Discrete elastic rods" (2008), eq. 1, between two directions; `fold_limit` as in
/// RopeSettings.
inline Vec3 curvature_of(Vec3 a, Vec3 b, double fold_limit) {
    return (2 / std::max(1 + dot(a, b), fold_limit)) * cross(a, b);
}

/// By the smallest turn that takes the unit vector a to b.
inline Vec3 carried(Vec3 v, Vec3 a, Vec3 b) {
    constexpr double opposite = 1e-9;  // 1 + a·b below which no turn is the smallest: keeps the quotient finite
    const Vec3 axis = cross(a, b);
    return dot(a, b) * v + cross(axis, v) + (dot(axis, v) / std::max(1 + dot(a, b), opposite)) * axis;
}

/// Damping acts on the growth of a turn of direction, not on its rotation with the rope.
inline Mat3 damping_of_growth(Vec3 turn, double damping) {
    constexpr double straight = 1e-4;  // rad²: a turn that is smaller has no axis yet
    const double size = length_squared(turn), turning = size / (size + straight);
    const Vec3 axis = normalized(turn);
    return damping * ((1 - turning) * Mat3::identity() + turning * outer(axis, axis));
}

}  // namespace embody::physics::deformable
