// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/constraint/contact/contact.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/settings/direct_settings.h"
#include "physics/linear/block_cholesky.h"

namespace embody::physics::constraint {

/// Components in a contact's frame (n, t1, t2) at its anchor: a relative velocity, or an impulse on b.
struct PatchTwist {
    Vec3 normal_part;    ///< along n; about t1, t2
    Vec3 friction_part;  ///< along t1, t2; about n
};
inline PatchTwist operator+(const PatchTwist& a, const PatchTwist& b) {
    return {a.normal_part + b.normal_part, a.friction_part + b.friction_part};
}
inline PatchTwist operator*(const PatchTwist& a, double factor) {
    return {a.normal_part * factor, a.friction_part * factor};
}
inline double dot(const PatchTwist& a, const PatchTwist& b) {
    return dot(a.normal_part, b.normal_part) + dot(a.friction_part, b.friction_part);
}

/// What bounds a patch's friction while Newton's method looks for it.
enum class FrictionBound {
    undamped,  ///< the load of the last iteration; new contacts, and sliding that reverses in the step, stick
    lagged,    ///< the load of the last iteration
    coupled,   ///< the load itself, found together with friction: for bodies at rest; sliding would lift them
};

/// A contact region as the direct solver sees it (docs/physics/direct-solver.md): a law of the impulse for a relative
/// velocity. Impulses are a substep's.
struct DirectPatch {
    static constexpr std::int32_t immovable = -1;  ///< no number: the body does not move

    struct Point {
        double s = 0, t = 0;        ///< from the anchor along t1, t2, m
        double gap = 0;             ///< now, m
        double guess = 0;           ///< λ₀, N s
        double load = 0;            ///< λ, N s
        double predicted = 0;       ///< λ by the slopes of the last iteration, N s
        double total = 0;           ///< of the step, N s
        double limit = 0;           ///< the approach speed that the gap allows, m/s
        double inactive_until = 0;  ///< s in the step
        bool is_active = true;
        bool is_loaded = false;  ///< the load answers the velocity
    };

    std::uint32_t contact = 0;                  ///< index
    std::int32_t a = immovable, b = immovable;  ///< the solver's number of the body
    Vec3 normal, tangent_1, tangent_2;          ///< world
    Vec3 arm_a, arm_b;                          ///< of the anchor, the points' centroid, m
    double friction_static = 0, friction_dynamic = 0;
    double rolling_arm = 0, torsion_arm = 0;  ///< m
    int count = 0;
    std::array<Point, Manifold::max_points> points;

    Vec3 friction_guess, friction, friction_total;  ///< along t1, t2; about n at the anchor, N s, N m s
    Vec3 rolling_guess, rolling;                    ///< x, y: about t1, t2, N m s
    bool sticks = true;                             ///< holds by static friction until the cone is left

    // Lagged: of the last iteration; of the first one with loads where the patch is new.
    bool is_new = true;
    double lagged_load = 0;             ///< N s
    double center_s = 0, center_t = 0;  ///< centre of pressure, m
    double spin_arm = 0;                ///< ρ, m

    // Of the last evaluation.
    bool is_sliding = false, is_rolling = false;
    double bound = 0;      ///< of the friction, N s
    Vec3 slide_direction;  ///< in the metric of friction
    PatchTwist velocity, impulse;
    Mat3 friction_slope = Mat3::zero();  ///< −∂friction_part of the impulse / ∂friction_part of the velocity
    Mat3 normal_slope = Mat3::zero();
    Mat3 coupling_slope = Mat3::zero();  ///< −∂normal_part of the impulse / ∂friction_part of the velocity
    PatchTwist change;                   ///< of the velocity, by a full step of Newton's method
    Mat3 factored_friction_slope = Mat3::zero(), factored_normal_slope = Mat3::zero(),
         factored_coupling_slope = Mat3::zero();
};

/// From a contact; `substep_fraction` is what the new substep is of the last one.
DirectPatch make_patch(std::uint32_t index, const Contact& contact, double substep_fraction);
/// Hands back impulses: those of a substep are `substep_fraction` of the patch's.
void write_patch(const DirectPatch& patch, double substep_fraction, Contact& contact);

/// The row that turns the normal part of a velocity into a point's separating speed.
inline Vec3 row_of(const DirectPatch::Point& point) { return {1, point.t, -point.s}; }

/// A substep of the direct solver.
struct PatchSubstep {
    double time = 0;      ///< of its end, s since the step began
    double duration = 0;  ///< s
    double slack = 0;     ///< m: a loaded point with a gap up to this counts as touching
};
void begin_substep(DirectPatch& patch, const PatchSubstep& substep, const DirectSettings& settings);
/// Before the first iteration with coupled bounds: the friction's metric by the guess.
void begin_coupled(DirectPatch& patch, const DirectSettings& settings);
/// The impulses become the next guess and part of the step's totals.
void end_substep(DirectPatch& patch);
/// The points' loads after the patch's change of velocity, if the same points stay loaded.
void predict_loads(DirectPatch& patch, double stiffness);
/// Whether the patch slides under the static coefficient: from then on the dynamic one counts.
bool breaks_away(DirectPatch& patch);

/// Stores the impulse for the patch's velocity, and how it changes with it. `stiffness` is k, kg.
void evaluate(DirectPatch& patch, double stiffness, FrictionBound bound, const DirectSettings& settings);
/// The impulse for another velocity under the same bounds; stores nothing.
PatchTwist impulse_at(const DirectPatch& patch, const PatchTwist& velocity, double stiffness, FrictionBound bound);
/// Leaves the slopes of the loaded points alone.
void drop_friction(DirectPatch& patch, double stiffness);
/// The same, if loaded points and sticking are as in the last substep.
void evaluate_as_before(DirectPatch& patch, double stiffness, const DirectSettings& settings);
/// Relative velocity (or small motion) of the bodies at the anchor.
PatchTwist relative_twist(const DirectPatch& patch, std::span<const Vec6> bodies);
/// Adds the impulse on b, and its opposite on a, to the bodies' right sides.
void add_impulse(const DirectPatch& patch, const PatchTwist& impulse, std::span<Vec6> bodies);

}  // namespace embody::physics::constraint
