// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/constraint/contact/contact.h"
#include "physics/definitions/settings/optimization_settings.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/namespace.h"

namespace embody::physics::optimization {

/// When an island's contacts should be solved directly (docs/physics/direct-solver.md).
enum class DirectUse {
    never,       ///< too large, has joints, or lies on a moving kinematic body
    while_slow,  ///< at rest, where one solve serves many steps
    always,      ///< tall and thin, or heavy on light: sweeps would tremble or fail
};
DirectUse direct_use_of(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                        std::span<const BodyState> bodies, const OptimizationSettings& settings);

}  // namespace embody::physics::optimization
