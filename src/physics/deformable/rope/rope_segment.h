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

/// Damping acts on the growth of a turn of direction, not on its rotation with the rope.
inline Mat3 damping_of_growth(Vec3 turn, double damping) {
    constexpr double straight = 1e-4;  // rad²: a turn that is smaller has no axis yet
    const double size = length_squared(turn), turning = size / (size + straight);
    const Vec3 axis = normalized(turn);
    return damping * ((1 - turning) * Mat3::identity() + turning * outer(axis, axis));
}

}  // namespace embody::physics::deformable
