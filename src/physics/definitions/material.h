// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "physics/definitions/surface_pairs.h"

namespace embody::physics {

/// How the coefficients of two touching bodies become one. Where two bodies ask for different rules, the later in this
/// order wins. pair_table: the coefficients that World::set_surface_pairs has for their surfaces; where it has none,
/// the geometric mean of the frictions and the larger restitution. own: the number of the body that asks for this rule,
/// measured against what it usually meets; the geometric mean where both ask for it.
enum class CombineRule { pair_table, own, average, geometric_mean, minimum, maximum, multiply };

/// Surface of a body.
struct Material {
    double friction_static = 0.5;   ///< Coulomb coefficient at rest, 0 … 2, >= friction_dynamic
    double friction_dynamic = 0.5;  ///< Coulomb coefficient while sliding, 0 … 2
    double friction_rolling = 0;    ///< lever arm of the rolling resistance, m, 0 … 0.05
    /// The lever arm on faces of bodies that have none of these, where it is the larger one: grains, m, 0 … 0.05
    double friction_rolling_on_others = 0;
    double friction_torsional = 0;     ///< lever arm of the spinning resistance, m, 0 … 0.1
    double restitution = 0;            ///< Stronge's energetic coefficient, 0 … 1
    double restitution_threshold = 0;  ///< slower approaches do not bounce, m/s, 0 … 10
    SurfaceId surface = 0;             ///< in World::set_surface_pairs; 0: in no row of it
    CombineRule friction_combine = CombineRule::geometric_mean;
    CombineRule restitution_combine = CombineRule::maximum;
};

/// The error's `where` is the field.
Result<void> validate(const Material& material);

/// The coefficients of a pair; symmetric in the two. friction_rolling_on_others is 0 where it does not count.
Material combine(const Material& a, const Material& b, const SurfacePairs& pairs);

/// Coulomb's law of a pair: sticking friction is at most at_rest times the load, sliding friction is `sliding` times
/// the load.
struct PairFriction {
    double at_rest = 0, sliding = 0;
    /// Slip speed up to which a contact still sticks, m/s: there friction begins to fall from the static to the sliding
    /// one (R. Stribeck 1902; measured 1e-4 to 1e-1 m/s, B. Armstrong-Hélouvry et al., Automatica 30, 1994). The load
    /// is unevenly distributed over the points of what bends; a point that slips a little passes its part of the load
    /// on and still sticks.
    static constexpr double stribeck_speed = 1e-3;
    [[nodiscard]] double coefficient(bool sticks) const { return sticks ? at_rest : sliding; }
};
/// The friction of combine().
PairFriction friction_between(const Material& a, const Material& b, const SurfacePairs& pairs);

}  // namespace embody::physics
