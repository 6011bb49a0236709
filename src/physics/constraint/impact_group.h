// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/frictional_impact.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics {

/// One place where two bodies collide or rest on each other while a neighbour collides.
struct ImpactSite {
    std::uint32_t a = 0, b = 0;       ///< body slots
    Vec3 arm_a, arm_b;                ///< from the centres of mass, world, at the moment of impact
    Vec3 normal;                      ///< from a to b, unit, world
    ImpactCoefficients coefficients;  ///< restitution 0 where the bodies only rest on each other
    Vec3 impulse;                     ///< out: on b, world, N s
};

struct ImpactReport {
    bool converged = true;     ///< false: some site still approaches after the allowed rounds
    double energy_change = 0;  ///< J, <= 0 up to rounding
};

/// Solves the collision of all sites together and changes the bodies' velocities.
ImpactReport solve_impact_group(std::span<ImpactSite> sites, std::span<BodyState> bodies);

}  // namespace embody::physics
