// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/constraint/contact.h"
#include "physics/optimization/islands.h"

namespace embody::physics {

/// Whether the island's contacts should be solved directly: it is cheap for what it is, or sweeps would fail
/// (docs/physics/direct-solver.md). An island with joints or on a moving kinematic body never is.
bool suits_direct_solve(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                        std::span<const BodyState> bodies);

}  // namespace embody::physics
