// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "math/transform.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

class CollisionShape;

using OutlineVisit = std::function<void(Vec3 from, Vec3 to)>;

/// Circles of round shapes are shown by so many lines.
inline constexpr int outline_circle_lines = 24;

/// Lines that show a shape, both ends of each on its surface, world: edges of polytopes and triangles, each once;
/// circles and sides of round shapes; of a plane a square grid of `plane_half_size` (m) about the point nearest to the
/// pose's origin.
void outline(const CollisionShape& shape, const Transform& pose, double plane_half_size, const OutlineVisit& visit);

}  // namespace embody::physics::collision
