// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/constraint/joint/joint_system.h"
#include "physics/constraint/namespace.h"
#include "physics/constraint/sweeps/contact_solver.h"
#include "physics/definitions/settings/constraint_settings.h"

namespace embody::physics::constraint {

/// Constraints that are solved together: indices into the arrays, in solve order. Knows no island; it is given one.
struct ConstraintList {
    std::span<Contact> contacts;
    std::span<const std::uint32_t> contact_order;
    std::span<const PreparedContact> prepared;  ///< one for each of contact_order
    std::span<Joint> joints;
    std::span<const std::uint32_t> joint_order;
    JointSystem* system = nullptr;  ///< all the joints, to be solved at once; null: one after the other
    const ConstraintSettings& settings;
};

/// Passes over the list in one phase: few for long lists, more for short ones, until a joint's error is gone. `time`:
/// of the substep's end in the step, s.
void solve_phase(const ConstraintList& list, SolvePhase phase, double substep, double time, std::span<BodyState> bodies,
                 std::span<const BodyConstants> constants);

}  // namespace embody::physics::constraint
