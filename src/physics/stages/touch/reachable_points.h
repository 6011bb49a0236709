// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/collision/broad_phase/broad_phase.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// Removes the points from the contacts of a rolling body that will not come within CollisionSettings::contact_margin
/// in this step: a wheel that rolls brings nothing of its rim to the ground but its lowest point, however far it goes.
/// Such points would move the place where friction acts up to the axle. The deepest point of each contact stays.
/// Returns the minimum separation of the removed points, m; 1e300 if there are none.
double leave_out_unreachable(const TouchAccess& world, const BroadPhase::Pair& pair, std::vector<Manifold>& manifolds);

}  // namespace embody::physics::stages
