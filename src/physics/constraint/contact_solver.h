// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/constraint/contact.h"

namespace embody::physics {

/// The two halves of a substep: before the drift the constraint holds for the mean velocity and takes penetration out;
/// after it, it holds for the velocity itself and takes no position error into the velocity.
enum class SolvePhase { position, velocity };

/// Stiffness of resting contacts for one length of substep.
struct ContactSoftness {
    double substep = 0;    ///< s
    double bias_rate = 0;  ///< share of the penetration taken out a second, 1/s
    double mass_scale = 1, impulse_scale = 0;
};
ContactSoftness contact_softness(double substep);

/// Effective masses; once a step, when arms and inertias are those of its start.
void prepare_contact(Contact& contact, std::span<const BodyState> bodies);

/// Applies the last impulses of this phase as the first guess.
void warm_start_contact(Contact& contact, SolvePhase phase, std::span<BodyState> bodies);

/// One pass over the region: each point's normal impulse, then friction within the cone, then torsion and rolling.
void solve_contact(Contact& contact, SolvePhase phase, const ContactSoftness& softness, std::span<BodyState> bodies);

/// Adds the phases' impulses to the step's totals; once a substep, after its velocity phase.
void add_to_totals(Contact& contact);

}  // namespace embody::physics
