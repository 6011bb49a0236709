// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "math/vec3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Barycentric weights of the triangle's point nearest to p.
std::array<double, 3> nearest_weights(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

/// Where on the segment from a to b the point nearest to p lies, 0 … 1.
double nearest_along(Vec3 p, Vec3 a, Vec3 b);

/// Where between the segments ab and cd the nearest points lie, 0 … 1 each; false where either is at an end, or they
/// are parallel.
bool nearest_inside(Vec3 a, Vec3 b, Vec3 c, Vec3 d, double& s, double& t);

/// Where on the segments ab and cd the points nearest to each other lie, 0 … 1 each.
std::array<double, 2> nearest_between(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace embody::physics::deformable
