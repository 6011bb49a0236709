// SPDX-License-Identifier: MIT
#pragma once

#include "math/mat3.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/impact_solver_settings.h"

namespace embody::physics::constraint {

// Vectors and matrices here are in the contact frame (t1, t2, n): x and y tangential, z along the normal.

struct ImpactCoefficients {
    double friction_slide = 0;  ///< Coulomb coefficient while the point slides
    double friction_stick = 0;  ///< Coulomb coefficient while it sticks, >= friction_slide
    double restitution = 0;     ///< Stronge's energetic coefficient, 0 … 1
};

/// How finely eq. (3) is integrated.
struct ImpactPrecision {
    /// Length of a step over the time of the fastest decay of the sliding, 0.01 … 0.5.
    double step_fraction = ImpactSolverSettings{}.expansion_step_fraction;
    /// Fraction of a step within which the end of a phase is found.
    double end_fraction = ImpactSolverSettings{}.expansion_end_fraction;
    double stop_speed = 0;  ///< m/s of sliding that counts as none; at least 1e-9 of the start speed
};

/// State of a micro-collision: what eq. (3) integrates over the normal impulse.
struct ImpactState {
    Vec3 velocity;           ///< relative velocity of the contact point, m/s
    Vec3 impulse;            ///< so far, N s
    double normal_work = 0;  ///< ∫ u_n dP₃ since the phase began, J
    bool sticks = false;     ///< the point sticks at the end of the last phase
};

struct ImpactOutcome {
    Vec3 velocity_after;
    Vec3 impulse;
    double compression_impulse = 0;  ///< normal impulse when the approach ended
    Vec3 compression_velocity;       ///< velocity at that moment
    bool sticks = false;
};

/// Integrates eq. (3) from `state` until the approach ends (u_n = 0).
void compress(const Mat3& inverse_mass, const ImpactCoefficients& coefficients, ImpactState& state,
              const ImpactPrecision& precision = {});

/// Integrates eq. (3) on until the normal work of this phase has reached `work` (J, >= 0).
void release(const Mat3& inverse_mass, const ImpactCoefficients& coefficients, double work, ImpactState& state,
             const ImpactPrecision& precision = {});

/// One point's collision from start to end. `inverse_mass` is A = J M⁻¹ Jᵀ, symmetric and positive definite (1/kg).
ImpactOutcome solve_frictional_impact(const Mat3& inverse_mass, Vec3 velocity, const ImpactCoefficients& coefficients);

}  // namespace embody::physics::constraint
