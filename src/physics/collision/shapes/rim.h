// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "math/vec3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Two unit directions in the plane of a rim (local, axis Y), from which its points are counted.
struct RimStart {
    Vec3 along, across;
};

/// Starts at the rim's point farthest along `direction` (local, unit), or, where the rim lies flat to it and the
/// farthest point would be noise, at a fixed one.
inline RimStart rim_start(Vec3 direction) {
    constexpr double flat = 1e-4;  // sine of the angle between rim and direction
    const double radial = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    const Vec3 along = radial > flat ? Vec3{direction.x / radial, 0, direction.z / radial} : Vec3{1, 0, 0};
    return {along, cross(along, {0, 1, 0})};
}

}  // namespace embody::physics::collision
