// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace embody {

/// Three doubles: a point, direction or vector in SI units, right-handed, Y up.
struct Vec3 {
    double x = 0, y = 0, z = 0;

    constexpr double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
constexpr Vec3& operator*=(Vec3& a, double s) { return a = a * s; }

constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double length_squared(Vec3 a) { return dot(a, a); }
inline double length(Vec3 a) { return std::sqrt(length_squared(a)); }
inline double distance(Vec3 a, Vec3 b) { return length(a - b); }

/// Unit vector along `a`, or `fallback` where `a` is too short to have a direction.
inline Vec3 normalized(Vec3 a, Vec3 fallback = {0, 0, 0}) {
    const double l = length(a);
    return l > 1e-150 ? a / l : fallback;
}

/// Product by components.
constexpr Vec3 scale(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 min(Vec3 a, Vec3 b) { return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z}; }
constexpr Vec3 max(Vec3 a, Vec3 b) { return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z}; }
inline Vec3 abs(Vec3 a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Some unit vector at right angles to the unit vector `n`; continuous except at two poles.
inline Vec3 any_perpendicular(Vec3 n) {
    return std::fabs(n.x) < 0.57735 ? normalized(cross(n, {1, 0, 0})) : normalized(cross(n, {0, 1, 0}));
}

/// Three floats, where memory counts more than digits: vertices of meshes, arms of contacts.
struct Vec3f {
    float x = 0, y = 0, z = 0;
    friend constexpr bool operator==(const Vec3f&, const Vec3f&) = default;
    /// Loses nothing.
    constexpr operator Vec3() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};
constexpr Vec3 to_vec3(Vec3f a) { return a; }
constexpr Vec3f to_vec3f(Vec3 a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

}  // namespace embody
