// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "physics/constraint/contact/contact.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/contact_settings.h"

namespace embody::physics::constraint {

/// The two halves of a substep: before the drift the constraints also take position errors out; after it they hold for
/// the velocity alone, so that no position error is left in it.
enum class SolvePhase { position, velocity };

/// Stiffness of the resting contacts of one list of constraints.
struct ContactSoftness {
    double substep = 0;    ///< s
    double bias_rate = 0;  ///< fraction of the penetration corrected a second, 1/s
    double mass_scale = 1, impulse_scale = 0;
    double push_speed = ContactSettings{}.max_correction_speed;    ///< overlapping bodies are separated no faster, m/s
    double penetration_slop = ContactSettings{}.penetration_slop;  ///< penetration beyond the sag that is not
                                                                   ///< corrected, m

    /// Depth to which a point sinks under its load: without it the point would not press back. `response` in 1/kg,
    /// `impulse` of a substep in N s.
    [[nodiscard]] double sag(double response, double impulse) const {
        const double stiffness = mass_scale * bias_rate;
        return stiffness > 0 ? impulse_scale * impulse * response / stiffness : 0;
    }
};

/// Whether the bodies resist rolling on each other.
inline bool resists_rolling(const Contact& contact) { return contact.friction_rolling > 0; }

/// How finely a list of contacts is solved. Long lists take twice the world's substeps with one pass each: small steps
/// rather than many iterations (M. Macklin et al., "Small Steps in Physics Simulation", 2019). Short lists converge
/// with the world's substeps and a second pass (docs/physics/contact-solver.md).
struct ContactPlan {
    int substeps = 1;
    int passes = 1;        ///< sweeps of each phase
    double stiffness = 0;  ///< contact frequency over substep frequency: the maximum that converges

    [[nodiscard]] ContactSoftness softness(double time_step, const ContactSettings& settings) const;
};
/// Of an island without joints; `substeps`: those of the world.
ContactPlan contact_plan(std::size_t contacts, int substeps, const ContactSettings& settings);
/// Of an island with joints, which keeps the world's substeps.
ContactPlan jointed_contact_plan(std::size_t contacts, int substeps, const ContactSettings& settings);

/// What the sweeps need of a contact: arms and inertias are those of the step's start.
struct PreparedContact {
    Anchor anchor;
    /// By point: places on the region from the anchor along the tangents, m; and what an impulse at the first point
    /// does to the normal speed of the second one, 1/kg.
    std::array<double, Manifold::max_points> along_1{}, along_2{};
    std::array<double, Manifold::max_points> normal_mass{};  ///< what the point alone has to move along the normal, kg
    std::array<std::array<double, Manifold::max_points>, Manifold::max_points> coupling{};
    /// Friction: what stops (u₁, u₂, ω_n) at the anchor together; what stops (u₁, u₂) alone; the largest response of
    /// the anchor's speed to a force and of the spin to a moment.
    Mat3 stop_all, stop_shift;
    double shift_response = 0, twist_response = 0;
};

/// Once a step.
PreparedContact prepare_contact(const Contact& contact, std::span<const BodyState> bodies);

/// Drops the impulses of points that are not there yet at `time` s after the step began; applies the last substep's
/// impulses of the others as the first guess; before the position phase.
void warm_start_contact(Contact& contact, const PreparedContact& prepared, double time, std::span<BodyState> bodies);

/// One pass over the region: friction within its limit, then the points' normal impulses, then rolling resistance.
void solve_contact(Contact& contact, const PreparedContact& prepared, SolvePhase phase, double time,
                   const ContactSoftness& softness, std::span<BodyState> bodies);

/// Adds the substep's impulses to the step's totals; after its velocity phase.
void add_to_totals(Contact& contact);

}  // namespace embody::physics::constraint
