// SPDX-License-Identifier: MIT
#include "physics/constraint/joint/own_spin.h"

#include <cmath>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

// Relative error up to which inertia and anchors are on the axis: rounding of definitions is below 1e-7, true offsets
// are above 1e-4.
constexpr double aligned = 1e-6;

// A turn by `angle` (rad, the length), of many Cayley turns: the library's sine differs by system. Right to 1e-3 at 4
// rad.
Quat turn_by(Vec3 angle) {
    constexpr int doublings = 6;  // of a 64th of the turn: each Cayley step is then below 0.0625 rad at 4 rad
    Quat turn = cayley(angle * (1.0 / (1 << doublings)));
    for (int i = 0; i < doublings; ++i) turn = turn * turn;
    return normalized(turn);
}

}  // namespace

// I = A (1 − e eᵀ) + C e eᵀ.
Vec3 symmetry_axis_along(Vec3 direction, const BodyConstants& constants) {
    const Vec3 axis = normalized(direction, {});
    const Mat3& inertia = constants.inertia;
    const double about = dot(axis, inertia * axis), sum = trace(inertia), across = (sum - about) / 2;
    const Mat3 rest = inertia - Mat3::identity() * across - outer(axis, axis) * (about - across);
    const double missed = length_squared(rest.x) + length_squared(rest.y) + length_squared(rest.z);
    return missed <= aligned * aligned * sum * sum ? axis : Vec3{};
}

bool is_on_axis(Vec3 point, Vec3 axis) {
    return axis != Vec3{} && length_squared(cross(point, axis)) <= aligned * aligned * length_squared(point);
}

OwnSpin own_spin_of(const BodyState& state, const BodyConstants& constants, Vec3 axis, double time) {
    const double rate = dot(state.angular_velocity, rotate(state.rotation, axis));
    if (rate == 0) return {};
    return {rate, rotate(state.rotation, constants.inertia * axis * rate), turn_by(axis * (rate * time))};
}

}  // namespace embody::physics::constraint
