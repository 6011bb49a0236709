// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/contact_region.h"
#include "physics/collision/shapes/convex.h"
#include "physics/collision/shapes/placed_triangle.h"

namespace embody::physics::collision {

// A convex against one triangle of a surface, in the convex's own frame. Each function fills an empty region with the
// points within the margin that belong to this triangle; its normal is set if there are points.

/// A polytope. True where the region holds all of its corners that are low over the triangle.
bool collide_polytope_triangle(const Convex& convex, const PlacedTriangle& triangle, double margin,
                               ContactRegion& region);
/// A sphere, capsule, cylinder or cone.
void collide_round_triangle(const Convex& convex, const PlacedTriangle& triangle, double margin, ContactRegion& region);

}  // namespace embody::physics::collision
