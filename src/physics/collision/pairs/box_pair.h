// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/convex_pair.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/collision/pairs/pair_memory.h"

namespace embody::physics::collision {

/// The result of a test of two boxes.
enum class BoxMeeting {
    none,      ///< nowhere within the margin
    region,    ///< the manifold is filled
    undecided  ///< no face or edge separates them or gives a region; they may still be close at a corner
};

/// Contact of two boxes in world axes with the origin at a's.
BoxMeeting collide_boxes(const ConvexPair& pair, double margin, PairMemory& memory, Manifold& manifold);

}  // namespace embody::physics::collision
