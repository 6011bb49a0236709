// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/deformable/nodes.h"

namespace embody::physics {

/// Of a deformable that nothing holds: changes `moves` (m, of a substep of h seconds) by a small move and turn of the
/// whole, so that momentum and angular momentum are those before and what is `given` from outside (N s, by node).
/// Elastic forces change neither; a solve that ended early does, and backward Euler slows turning.
void keep_momenta(const Nodes& nodes, std::span<const Vec3> given, double h, std::span<Vec3> moves);

}  // namespace embody::physics
