// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "math/transform.h"

namespace embody {

/// Axis-aligned box; empty (lower > upper) until something is added.
struct Bounds {
    Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
    Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity()};

    [[nodiscard]] constexpr bool is_empty() const {
        return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z;
    }
    [[nodiscard]] constexpr Vec3 center() const { return (lower + upper) * 0.5; }
    [[nodiscard]] constexpr Vec3 size() const { return upper - lower; }
    [[nodiscard]] constexpr Vec3 half_extents() const { return size() * 0.5; }
    constexpr void add(Vec3 p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    constexpr void add(const Bounds& b) {
        lower = min(lower, b.lower);
        upper = max(upper, b.upper);
    }
};

constexpr bool overlaps(const Bounds& a, const Bounds& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}
constexpr bool contains(const Bounds& outer, const Bounds& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
           inner.upper.x <= outer.upper.x && inner.upper.y <= outer.upper.y && inner.upper.z <= outer.upper.z;
}
constexpr bool contains(const Bounds& b, Vec3 p) { return contains(b, Bounds{p, p}); }
constexpr Bounds enlarged(const Bounds& b, double margin) {
    const Vec3 m{margin, margin, margin};
    return {b.lower - m, b.upper + m};
}
/// Bounds of the box `b` after `t`.
inline Bounds transformed(const Transform& t, const Bounds& b) {
    const Mat3 r = to_matrix(t.rotation);
    const Vec3 h = b.half_extents();
    const Vec3 c = transform_point(t, b.center());
    const Vec3 e = abs(r.x) * h.x + abs(r.y) * h.y + abs(r.z) * h.z;
    return {c - e, c + e};
}

}  // namespace embody
