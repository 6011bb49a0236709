// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mass_properties.h"
#include "physics/collision/namespace.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// Of the homogeneous solid at density 1, in the convex's own frame: closed forms for round shapes, integration over
/// the tetrahedra of a fan for polytopes.
geometry::MassProperties mass_of(const Convex& convex);

}  // namespace embody::physics::collision
