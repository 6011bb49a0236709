// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "physics/constraint/contact.h"

namespace embody::physics {

/// The two halves of a substep: before the drift the constraints also take position errors out; after it they hold for
/// the velocity alone, so that no position error is left in it.
enum class SolvePhase { position, velocity };

/// Stiffness of the resting contacts of one list of constraints.
struct ContactSoftness {
    double substep = 0;    ///< s
    double bias_rate = 0;  ///< share of the penetration taken out a second, 1/s
    double mass_scale = 1, impulse_scale = 0;
    double push_speed = 3;  ///< overlapping bodies part no faster than this, m/s
};

/// Whether the patch resists spinning or rolling.
inline bool resists_turning(const Contact& contact) {
    return contact.material.friction_rolling > 0 || contact.material.friction_torsional > 0;
}

/// The stiffest that converges: a short list gets more passes (contact_passes()) and so may be stiffer.
ContactSoftness contact_softness(double substep, std::size_t contacts);

/// Whether a list is short enough for several passes, and so for stiff contacts.
bool has_few_contacts(std::size_t contacts);

/// Passes a phase over a list of that many contacts: a long list gets one, since the substeps and the warm start do the
/// work; for a short one more cost nothing.
int contact_passes(std::size_t contacts);

/// Effective masses; once a step, when arms and inertias are those of its start.
void prepare_contact(Contact& contact, std::span<const BodyState> bodies);

/// Applies the last substep's impulses as the first guess; before the position phase.
void warm_start_contact(const Contact& contact, std::span<BodyState> bodies);

/// One pass over the region: friction within the cone, then each point's normal impulse, then torsion and rolling.
void solve_contact(Contact& contact, SolvePhase phase, const ContactSoftness& softness, std::span<BodyState> bodies);

/// Adds the substep's impulses to the step's totals; after its velocity phase.
void add_to_totals(Contact& contact);

}  // namespace embody::physics
