// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "physics/collision/namespace.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// Where a ray (unit direction) enters a convex within `max_distance` (m), all in the convex's frame; nothing from
/// inside.
std::optional<ShapeRayHit> cast_ray(const Convex& convex, Vec3 origin, Vec3 direction, double max_distance);

}  // namespace embody::physics::collision
