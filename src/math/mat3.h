// SPDX-License-Identifier: MIT
#pragma once

#include "math/vec3.h"

namespace embody {

/// 3×3 matrix by columns: m * v = x v.x + y v.y + z v.z.
struct Mat3 {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    static constexpr Mat3 identity() { return {}; }
    static constexpr Mat3 zero() { return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}; }
    static constexpr Mat3 diagonal(Vec3 d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }

    constexpr Vec3& column(int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr Vec3 column(int i) const { return i == 0 ? x : i == 1 ? y : z; }
    /// Element of row `r`, column `c`.
    constexpr double operator()(int r, int c) const { return column(c)[r]; }
    constexpr double& operator()(int r, int c) { return column(c)[r]; }
    friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

constexpr Vec3 operator*(const Mat3& m, Vec3 v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.x, a * b.y, a * b.z}; }
constexpr Mat3 operator+(const Mat3& a, const Mat3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Mat3 operator-(const Mat3& a, const Mat3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Mat3 operator*(const Mat3& m, double s) { return {m.x * s, m.y * s, m.z * s}; }
constexpr Mat3 operator*(double s, const Mat3& m) { return m * s; }
constexpr Mat3& operator+=(Mat3& a, const Mat3& b) { return a = a + b; }

constexpr Mat3 transpose(const Mat3& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
constexpr double determinant(const Mat3& m) { return dot(m.x, cross(m.y, m.z)); }
constexpr double trace(const Mat3& m) { return m.x.x + m.y.y + m.z.z; }

/// Inverse by cofactors, or the zero matrix where `m` is singular (an immovable body has zero inverse inertia).
constexpr Mat3 inverse_or_zero(const Mat3& m) {
    const double d = determinant(m);
    if (d == 0) return Mat3::zero();
    return transpose(Mat3{cross(m.y, m.z) / d, cross(m.z, m.x) / d, cross(m.x, m.y) / d});
}

/// The matrix of v ↦ a × v.
constexpr Mat3 skew(Vec3 a) { return {{0, a.z, -a.y}, {-a.z, 0, a.x}, {a.y, -a.x, 0}}; }
/// a bᵀ.
constexpr Mat3 outer(Vec3 a, Vec3 b) { return {a * b.x, a * b.y, a * b.z}; }

/// Solves m x = b; zero where `m` is singular.
constexpr Vec3 solve(const Mat3& m, Vec3 b) { return inverse_or_zero(m) * b; }

/// Eigenvalues (ascending) and unit eigenvectors (columns, right-handed) of a symmetric matrix, by cyclic
/// Jacobi rotations (Golub & Van Loan, Matrix Computations, 8.5).
struct SymmetricEigen {
    Vec3 values;
    Mat3 vectors;
};
SymmetricEigen eigen_symmetric(const Mat3& m);

}  // namespace embody
