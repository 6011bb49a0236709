// SPDX-License-Identifier: MIT
#pragma once

#include "math/quat.h"
#include "math/vec3.h"

namespace embody {

/// Rigid placement, the paper's eq. (1): a local point p is at position + rotation p in the parent's frame.
struct Transform {
    Vec3 position;
    Quat rotation;
    friend constexpr bool operator==(const Transform&, const Transform&) = default;
};

constexpr Vec3 transform_point(const Transform& t, Vec3 p) { return t.position + rotate(t.rotation, p); }
constexpr Vec3 inverse_transform_point(const Transform& t, Vec3 p) {
    return rotate_inverse(t.rotation, p - t.position);
}
/// First `b`, then `a`.
constexpr Transform operator*(const Transform& a, const Transform& b) {
    return {transform_point(a, b.position), a.rotation * b.rotation};
}
constexpr Transform inverse(const Transform& t) {
    return {rotate_inverse(t.rotation, -t.position), conjugate(t.rotation)};
}
inline bool is_finite(const Transform& t) { return is_finite(t.position) && is_finite(t.rotation); }

}  // namespace embody
