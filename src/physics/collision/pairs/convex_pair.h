// SPDX-License-Identifier: MIT
#pragma once

#include "math/quat.h"
#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// The matrix of a unit quaternion, by products alone.
inline Mat3 turn_of(Quat q) {
    const double x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const double xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
    const double wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
    return {{1 - (yy + zz), xy + wz, xz - wy}, {xy - wz, 1 - (xx + zz), yz + wx}, {xz + wy, yz - wx, 1 - (xx + yy)}};
}

/// aᵀ b.
inline Mat3 transposed_product(const Mat3& a, const Mat3& b) {
    const auto column = [&a](Vec3 v) { return Vec3{dot(a.x, v), dot(a.y, v), dot(a.z, v)}; };
    return {column(b.x), column(b.y), column(b.z)};
}

/// Two convex pieces. They are compared in the own frame of the first: it needs no rotation there, and far from the
/// world's origin no digit is lost.
struct ConvexPair {
    const Convex* a = nullptr;
    const Convex* b = nullptr;
    Mat3 turn_a, turn_b;  ///< from each piece's frame to the world
    Vec3 apart;           ///< from a's origin to b's, in the world
    Mat3 turn;            ///< from b's frame to a's
    Vec3 place;           ///< b's origin in a's frame

    ConvexPair(const Convex& first, const Mat3& first_turn, const Convex& second, const Mat3& second_turn,
               Vec3 displacement)
        : a(&first), b(&second), turn_a(first_turn), turn_b(second_turn), apart(displacement) {
        turn = transposed_product(turn_a, turn_b);
        place = {dot(turn_a.x, apart), dot(turn_a.y, apart), dot(turn_a.z, apart)};
    }
    [[nodiscard]] PlacedConvex placed_a() const { return {a, {}, {}}; }
    [[nodiscard]] PlacedConvex placed_b() const { return {b, turn, place}; }
};

}  // namespace embody::physics::collision
