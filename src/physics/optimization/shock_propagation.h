// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/definitions/settings/optimization_settings.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/namespace.h"

namespace embody::physics::optimization {

/// How much is taken out, and what soft contacts keep of it.
struct ShockRules {
    const OptimizationSettings& settings;
    ContactSoftness softness;
};

/// Takes out the penetration that the solver left in a deep island (beyond the sag of its soft contacts), in one sweep
/// from the ground up, in which a lower body is immovable for the ones above it. Changes positions only, never a
/// velocity.
void propagate_shock(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                     const ShockRules& rules, std::span<BodyState> bodies);

}  // namespace embody::physics::optimization
