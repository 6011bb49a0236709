// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "physics/definitions/surface_pairs.h"

namespace embody::physics {

/// How the coefficients of two touching bodies become one. Where two bodies ask for different rules, the later in
/// this order wins. pair_table: what World::set_surface_pairs says of their surfaces; where it says nothing, the
/// geometric mean of the frictions and the larger restitution. own: the number of the body that says so, measured
/// against whatever it usually meets; the geometric mean where both do.
enum class CombineRule { pair_table, own, average, geometric_mean, minimum, maximum, multiply };

/// Surface of a body.
struct Material {
    double friction_static = 0.5;      ///< Coulomb coefficient at rest, 0 … 2, >= friction_dynamic
    double friction_dynamic = 0.5;     ///< Coulomb coefficient while sliding, 0 … 2
    double friction_rolling = 0;       ///< lever arm of the rolling resistance, m, 0 … 0.05
    double friction_torsional = 0;     ///< lever arm of the spinning resistance, m, 0 … 0.1
    double restitution = 0;            ///< Stronge's energetic coefficient, 0 … 1
    double restitution_threshold = 0;  ///< approach speeds below this do not bounce, m/s, 0 … 10
    SurfaceId surface = 0;             ///< in World::set_surface_pairs; 0: in no row of it
    CombineRule friction_combine = CombineRule::geometric_mean;
    CombineRule restitution_combine = CombineRule::maximum;
};

/// The error's `where` is the field.
Result<void> validate(const Material& material);

/// The coefficients of a pair; symmetric in the two.
Material combine(const Material& a, const Material& b, const SurfacePairs& pairs);

/// Coulomb's law of a pair: what sticks holds up to at_rest times the load, what slides is braked by sliding times it.
struct PairFriction {
    double at_rest = 0, sliding = 0;
    /// What slips no faster than this still sticks, m/s: where friction begins to fall from the static to the sliding
    /// one (R. Stribeck 1902; measured 1e-4 to 1e-1 m/s, B. Armstrong-Hélouvry et al., Automatica 30, 1994). Points of
    /// what bends share a load unevenly; one that gives way a little hands its part on and is not lost.
    static constexpr double stribeck_speed = 1e-3;
    [[nodiscard]] double coefficient(bool sticks) const { return sticks ? at_rest : sliding; }
};
/// The same of combine().
PairFriction friction_between(const Material& a, const Material& b, const SurfacePairs& pairs);

}  // namespace embody::physics
