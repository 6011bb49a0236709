// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "math/mat3.h"
#include "math/vec3.h"

namespace embody {

/// Unit quaternion x i + y j + z k + w, components in glTF's order. Rotates by v ↦ q v q*.
struct Quat {
    double x = 0, y = 0, z = 0, w = 1;
    friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

constexpr Quat operator*(Quat a, Quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr Quat conjugate(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr double dot(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

/// Unit length; the identity where `q` has no direction.
inline Quat normalized(Quat q) {
    const double l = std::sqrt(dot(q, q));
    return l > 1e-150 ? Quat{q.x / l, q.y / l, q.z / l, q.w / l} : Quat{};
}

constexpr Vec3 rotate(Quat q, Vec3 v) {
    const Vec3 u{q.x, q.y, q.z};
    const Vec3 t = 2.0 * cross(u, v);
    return v + q.w * t + cross(u, t);
}
constexpr Vec3 rotate_inverse(Quat q, Vec3 v) { return rotate(conjugate(q), v); }

constexpr Mat3 to_matrix(Quat q) { return {rotate(q, {1, 0, 0}), rotate(q, {0, 1, 0}), rotate(q, {0, 0, 1})}; }

/// The rotation of a right-handed orthonormal matrix (Shepperd, 1978).
inline Quat to_quat(const Mat3& m) {
    const double t = trace(m);
    Quat q;
    if (t > m(0, 0) && t > m(1, 1) && t > m(2, 2)) {
        q = {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1), 1 + t};
    } else if (m(0, 0) >= m(1, 1) && m(0, 0) >= m(2, 2)) {
        q = {1 + 2 * m(0, 0) - t, m(0, 1) + m(1, 0), m(0, 2) + m(2, 0), m(2, 1) - m(1, 2)};
    } else if (m(1, 1) >= m(2, 2)) {
        q = {m(0, 1) + m(1, 0), 1 + 2 * m(1, 1) - t, m(1, 2) + m(2, 1), m(0, 2) - m(2, 0)};
    } else {
        q = {m(0, 2) + m(2, 0), m(1, 2) + m(2, 1), 1 + 2 * m(2, 2) - t, m(1, 0) - m(0, 1)};
    }
    return normalized(q);
}

/// Rotation by `angle` (rad) about the unit vector `axis`.
inline Quat from_axis_angle(Vec3 axis, double angle) {
    const double s = std::sin(angle / 2);
    return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle / 2)};
}

/// The shortest rotation that takes the unit vector `a` to the unit vector `b`.
inline Quat from_two_vectors(Vec3 a, Vec3 b) {
    const double d = dot(a, b);
    if (d < -1 + 1e-12) {
        const Vec3 axis = any_perpendicular(a);
        return {axis.x, axis.y, axis.z, 0};
    }
    const Vec3 c = cross(a, b);
    return normalized(Quat{c.x, c.y, c.z, 1 + d});
}

inline bool is_finite(Quat q) {
    return std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w);
}

/// R m Rᵀ: a body-frame tensor seen from the world.
constexpr Mat3 rotate_tensor(Quat q, const Mat3& m) {
    const Mat3 r = to_matrix(q);
    return r * m * transpose(r);
}

}  // namespace embody
