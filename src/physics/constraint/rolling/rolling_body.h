// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/rolling_settings.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// A torus around the axis (Y) of a rolling body: the rim of a cylinder or cone has no tube radius, a capsule's end has
/// no ring radius, a cone's apex has neither. Body axes, m.
struct RollingRing {
    Vec3 center;  ///< from the centre of mass
    double radius = 0, tube = 0;
};

/// A body of revolution that rolls alone on something flat that stands still: on one of its rings, or on the line
/// between two.
struct RollingBody {
    static constexpr int max_rings = 8;  ///< rings of four cylinders on one axle; the contact solver takes bodies with
                                         ///< more
    Vec3 axis;                           ///< body axes, unit
    std::array<RollingRing, max_rings> rings;
    int ring_count = 0;
    double size = 0;  ///< farthest surface point from the centre of mass, m

    void add(const RollingRing& ring) { rings[static_cast<std::size_t>(ring_count++)] = ring; }
};
struct RollingGround {
    Vec3 normal;      ///< world, unit, towards the body
    Vec3 point;       ///< where the surface is, world
    double friction;  ///< of Coulomb, at rest
    bool holds;       ///< the body stuck to it in the last step
};

/// For how long, and how.
struct RollingStep {
    double time = 0;  ///< s
    const RollingSettings& settings;
};

/// Takes the body through the time in pure rolling: Lagrange's equations (paper, eq. 2) with the constraint that the
/// place that touches stands still, by the classical Runge-Kutta method in as many parts as the motion asks for; no
/// work but that of `constants.acceleration` is done. Returns the ground's impulse, N s. Nothing is changed and there
/// is no result where the body does not roll like that: it slips or lifts off, the ground would have to pull or to have
/// more friction, or the body lies on more than one point or the side's line.
std::optional<Vec3> roll(BodyState& state, const BodyConstants& constants, const RollingBody& body,
                         const RollingGround& ground, const RollingStep& step);

}  // namespace embody::physics::constraint
