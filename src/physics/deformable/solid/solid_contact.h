// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "math/vec3.h"
#include "physics/definitions/material.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A point that up to three nodes of a solid carry.
struct CarriedPoint {
    std::uint32_t solid = 0;  ///< index in the list of solids
    std::uint32_t count = 0;  ///< of nodes; 0: no point
    std::array<std::uint32_t, 3> node{};
    std::array<double, 3> weight{};  ///< their sum is 1
};

/// A place where a solid may touch a body or another solid, or is held to a body.
struct SolidContact {
    CarriedPoint point;      ///< of the solid that `force` acts on
    CarriedPoint other;      ///< on the surface of the other solid; none where the other is a body
    std::uint32_t body = 0;  ///< index in the list of bodies, where there is no other solid
    /// Identity of the contact in the next step: slot of the body, or no_body + slot of the other solid.
    std::uint64_t partner = 0;
    std::uint32_t feature = 0;  ///< 1 + which of the body's features it is; 0: a face of the body under a node
    Vec3 anchor;                ///< on the body, from its centre of mass when the step began, m
    Vec3 normal;                ///< from the other to the solid when the step began
    double radius = 0;          ///< distance that the two keep, m
    PairFriction friction;      ///< of the two surfaces
    bool sticks = true;         ///< holds by static friction until its limit is left
    bool holds = false;         ///< the point stays at the anchor, whatever force that takes
    bool parts = false;         ///< the two solids lie within each other and are being separated
    Vec3 force;                 ///< on the solid in the last substep, N; the next one begins with it
    /// Coulomb coefficient for its state.
    [[nodiscard]] double present_friction() const { return friction.coefficient(sticks); }
    [[nodiscard]] bool has_body() const { return other.count == 0; }
};

}  // namespace embody::physics::deformable
