// SPDX-License-Identifier: MIT
//
// Micro-collision: the tangential velocity changes with the normal impulse and the direction of sliding is free (paper,
// eq. 3). Sources: V. Bhatt, J. Koechlin, "Partial solution for the three-dimensional impact", 1995 (flow of the
// sliding velocity, the stick condition, the diverging direction); B. Mirtich, "Impulse-based dynamic simulation of
// rigid body systems", 1996 (integration over the normal impulse); W. Stronge, "Rigid body collisions with friction",
// 1990 (restitution as a ratio of the normal work).
//
//   symbol   meaning                                             here
//   u        relative velocity at the contact (t1, t2, n)        state.velocity
//   P        impulse, P₃ its normal part                         state.impulse
//   A        K^T M⁻¹ K of eq. (3), 3×3                           inverse_mass
//   μ        Coulomb coefficient                                 friction_slide, friction_stick
//   d        direction of sliding u_t / |u_t|
//   W        ∫ u_n dP₃                                           state.normal_work
//
//   sliding   du/dP₃ = A (−μ d, 1)
//   sticking  du_t = 0:  dP_t/dP₃ = −A_tt⁻¹ A_tn,  possible if |A_tt⁻¹ A_tn| <= μ_stick
//   else      slide on along the one d with A_tn − μ A_tt d = k d, k > 0; d then stays
//   end       W_release = e² |W_compress|
// Where d stays, all rates are constant and the phase is solved in closed form. Where d turns, the equation is
// integrated by RK4 over τ with dP₃ = |u_t| dτ, which is smooth at u_t = 0:
//   du/dτ = A (−μ u_t, |u_t|),   dW/dτ = u_n |u_t|.
#include "physics/constraint/impact/frictional_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace embody::physics::constraint {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Numbers of the integration, which follows eq. (3) to about the last digits that ImpactPrecision asks for; callers
// choose those (ImpactSolverSettings).
constexpr double stop_fraction = 1e-9;  // of the start velocity: slower sliding is none, rounding leaves 1e-16 a step
constexpr double straight_fraction = 1e-8;  // of the start velocity, by which a slide taken as straight misses its path
constexpr double above_zero = 1e-300;       // m/s: speed that counts as none where nothing moves
constexpr double straight_rounding = 1e-13;  // sine of a slide's turn that is only rounding
// Most collisions end within the first short steps. Where A is ill-conditioned u_t decays slowly, and steps may grow;
// they may from the start where less than the last digits is asked for.
constexpr double exact_step_fraction = 0.1;  // ImpactPrecision::step_fraction up to which steps may not grow from the
                                             // start
constexpr int short_steps = 400;             // of 0.1: a decay to e⁻⁴⁰
constexpr double max_fraction = 1.5;     // of the fastest decay, of a step: Runge-Kutta of order 4 is stable up to 2.78
constexpr int max_steps = 20000;         // bounds the loop where A is so ill-conditioned that no step ends it
constexpr int end_searches = 60;         // bisection ends with the last bit of a double
constexpr int direction_searches = 200;  // bounds the loop where the direction does not settle
constexpr double direction_rounding = 1e-28;  // squared turn of the direction: 1e-14 rad

enum class Phase { compression, restitution };

struct Collision {
    const Mat3& a;
    const ImpactCoefficients& c;
    Phase phase;
    double target_work;  // restitution only
    ImpactPrecision precision;
    ImpactState& s;
};

Vec3 tangential(Vec3 v) { return {v.x, v.y, 0}; }

Vec3 solve_tangential(const Mat3& a, Vec3 b) {
    const double det = a.x.x * a.y.y - a.y.x * a.x.y;
    if (!(det > 0)) return {};
    return {(a.y.y * b.x - a.y.x * b.y) / det, (a.x.x * b.y - a.x.y * b.x) / det, 0};
}

// The normal impulse after which the phase ends while u_n changes at the constant `rate`.
double impulse_to_end(const Collision& k, double rate) {
    const double un = k.s.velocity.z;
    if (k.phase == Phase::compression) return rate > 0 ? std::max(0.0, -un / rate) : infinity;

    // W + u_n p + ½ rate p² = target; if the separating speed becomes zero first, the phase ends there.
    const double missing = k.target_work - k.s.normal_work;
    if (missing <= 0) return 0;
    const double discriminant = un * un + 2 * rate * missing;
    if (discriminant < 0) return un > 0 ? -un / rate : 0;
    const double denominator = un + std::sqrt(discriminant);
    return denominator > 0 ? 2 * missing / denominator : infinity;
}

// Applies `amount` of normal impulse with the constant tangential part `ratio` (dP_t/dP₃).
void advance_linearly(const Collision& k, Vec3 ratio, double amount) {
    const Vec3 direction{ratio.x, ratio.y, 1};
    const Vec3 change = k.a * direction * amount;
    k.s.normal_work += (k.s.velocity.z + 0.5 * change.z) * amount;
    k.s.impulse += direction * amount;
    k.s.velocity += change;
}

struct Derivative {
    Vec3 velocity, impulse;
    double work;
};

Derivative rate_over_tau(const Collision& k, Vec3 u) {
    const double slip = std::sqrt(u.x * u.x + u.y * u.y);
    const Vec3 impulse{-k.c.friction_slide * u.x, -k.c.friction_slide * u.y, slip};
    return {k.a * impulse, impulse, u.z * slip};
}

ImpactState runge_kutta_step(const Collision& k, const ImpactState& s, double tau) {
    const Derivative k1 = rate_over_tau(k, s.velocity);
    const Derivative k2 = rate_over_tau(k, s.velocity + k1.velocity * (tau / 2));
    const Derivative k3 = rate_over_tau(k, s.velocity + k2.velocity * (tau / 2));
    const Derivative k4 = rate_over_tau(k, s.velocity + k3.velocity * tau);
    ImpactState next = s;
    next.velocity += (k1.velocity + 2.0 * k2.velocity + 2.0 * k3.velocity + k4.velocity) * (tau / 6);
    next.impulse += (k1.impulse + 2.0 * k2.impulse + 2.0 * k3.impulse + k4.impulse) * (tau / 6);
    next.normal_work += (k1.work + 2 * k2.work + 2 * k3.work + k4.work) * (tau / 6);
    return next;
}

// Positive once the phase is over.
double overshoot(const Collision& k, const ImpactState& s) {
    if (k.phase == Phase::compression) return s.velocity.z;
    const double surplus = s.normal_work - k.target_work;
    return s.velocity.z < 0 ? std::max(surplus, -s.velocity.z) : surplus;
}

// The step length in (0, tau] at which the phase ends, by bisection with secants (Illinois).
ImpactState step_to_end(const Collision& k, double tau) {
    double low = 0, high = tau;
    double at_low = overshoot(k, k.s), at_high = overshoot(k, runge_kutta_step(k, k.s, tau));
    ImpactState best = runge_kutta_step(k, k.s, tau);
    for (int i = 0; i < end_searches && high - low > k.precision.end_fraction * tau; ++i) {
        const double guess = at_high > at_low ? high - at_high * (high - low) / (at_high - at_low) : (low + high) / 2;
        const double middle = std::clamp(guess, low, high);
        best = runge_kutta_step(k, k.s, middle);
        const double value = overshoot(k, best);
        if (std::fabs(value) <= k.precision.end_fraction * std::max(at_high, -at_low)) break;
        if (value > 0) {
            high = middle;
            at_high = value;
            at_low /= 2;
        } else {
            low = middle;
            at_low = value;
            at_high /= 2;
        }
    }
    return best;
}

// Slides along the constant direction `d`. True if the phase ended, false if the sliding did.
bool slide_straight(const Collision& k, Vec3 d);

// Slides while the direction turns. True if the phase ended; false if the point stopped sliding first.
bool slide_curved(const Collision& k) {
    const double start_slip = length(tangential(k.s.velocity));
    const double norm_tt = std::fabs(k.a.x.x) + std::fabs(k.a.y.y) + 2 * std::fabs(k.a.x.y);
    const double norm_tn = std::fabs(k.a.z.x) + std::fabs(k.a.z.y);
    const double fastest_decay = k.c.friction_slide * norm_tt + norm_tn;
    const double shortest = k.precision.step_fraction / fastest_decay, longest = max_fraction / fastest_decay;
    for (int i = 0; i < max_steps; ++i) {
        // A slow decay gets longer steps, within what keeps RK4 stable.
        const Vec3 sliding = tangential(k.s.velocity), rate = tangential(rate_over_tau(k, sliding).velocity);
        const double slip = length(sliding), change = length(rate);

        // Towards its end the sliding hardly turns any more: taking the rest as straight makes no error.
        const double turning = std::fabs(sliding.x * rate.y - sliding.y * rate.x);
        if (turning <= straight_fraction * start_slip * change) return slide_straight(k, sliding / slip);
        const double wanted = change > 0 ? k.precision.step_fraction * slip / change : longest;
        const bool is_short = i < short_steps && k.precision.step_fraction <= exact_step_fraction;
        const double tau = is_short ? shortest : std::clamp(wanted, shortest, longest);
        const ImpactState next = runge_kutta_step(k, k.s, tau);
        if (overshoot(k, next) >= 0) {
            k.s = step_to_end(k, tau);
            return true;
        }
        k.s = next;
        if (length(tangential(k.s.velocity)) <= k.precision.stop_speed) return false;
    }
    return false;
}

bool slide_straight(const Collision& k, Vec3 d) {
    const Vec3 ratio = -k.c.friction_slide * d;
    const Vec3 rate = k.a * Vec3{ratio.x, ratio.y, 1};
    const double slip_rate = dot(rate, d);
    const double to_stop = slip_rate < 0 ? length(tangential(k.s.velocity)) / -slip_rate : infinity;
    const double to_end = impulse_to_end(k, rate.z);

    // Neither end in sight: a normal velocity that grows without bound, which a positive definite A excludes.
    if (to_stop == infinity && to_end == infinity) return true;
    advance_linearly(k, ratio, std::min(to_stop, to_end));
    if (to_end <= to_stop) return true;
    k.s.velocity.x = k.s.velocity.y = 0;
    return false;
}

// The direction d, |d| = 1, along which a point at rest starts to slide: A_tn − μ A_tt d = k d, k > 0.
Vec3 diverging_direction(const Collision& k) {
    const Vec3 a_tn = tangential(k.a.z);
    const auto acceleration = [&](Vec3 d) { return a_tn - k.c.friction_slide * tangential(k.a * d); };

    // The sliding velocity's own flow turns towards that direction, so follow it: d ← normalised acceleration + push.
    const double push = k.c.friction_slide * (k.a.x.x + k.a.y.y);
    Vec3 d = normalized(a_tn, {1, 0, 0});
    for (int i = 0; i < direction_searches; ++i) {
        const Vec3 next = normalized(acceleration(d) + push * d, d);
        const bool settled = length_squared(next - d) < direction_rounding;
        d = next;
        if (settled) break;
    }
    return d;
}

void run_phase(const Collision& k) {
    k.s.sticks = false;
    const Vec3 slip = tangential(k.s.velocity);
    const double speed = length(slip);

    // Without friction the impulse is normal whatever the point does.
    if (k.c.friction_stick <= 0) {
        const double amount = impulse_to_end(k, k.a.z.z);
        if (amount < infinity) advance_linearly(k, {}, amount);
        return;
    }
    if (speed > k.precision.stop_speed) {
        const Vec3 d = slip / speed;
        const Vec3 rate = tangential(k.a * Vec3{-k.c.friction_slide * d.x, -k.c.friction_slide * d.y, 1});
        const bool is_straight = std::fabs(d.x * rate.y - d.y * rate.x) <= straight_rounding * length(rate);
        if (is_straight ? slide_straight(k, d) : slide_curved(k)) return;
    }
    k.s.velocity.x = k.s.velocity.y = 0;

    // The point has stopped: it sticks if friction can hold it, else it slides on.
    const Vec3 hold = -solve_tangential(k.a, k.a.z);
    if (length(hold) <= k.c.friction_stick) {
        const double rate = (k.a * Vec3{hold.x, hold.y, 1}).z;
        const double amount = impulse_to_end(k, rate);
        if (amount < infinity) advance_linearly(k, hold, amount);
        k.s.velocity.x = k.s.velocity.y = 0;
        k.s.sticks = true;
    } else {
        slide_straight(k, diverging_direction(k));
    }
}

ImpactPrecision at_least_relative(const ImpactPrecision& precision, const ImpactState& state) {
    return {precision.step_fraction, precision.end_fraction,
            std::max(precision.stop_speed, stop_fraction * length(state.velocity) + above_zero)};
}

}  // namespace

void compress(const Mat3& inverse_mass, const ImpactCoefficients& coefficients, ImpactState& state,
              const ImpactPrecision& precision) {
    state.normal_work = 0;
    if (state.velocity.z >= 0) return;
    run_phase({inverse_mass, coefficients, Phase::compression, 0, at_least_relative(precision, state), state});
}

void release(const Mat3& inverse_mass, const ImpactCoefficients& coefficients, double work, ImpactState& state,
             const ImpactPrecision& precision) {
    state.normal_work = 0;
    if (work <= 0) return;
    state.velocity.z = std::max(state.velocity.z, 0.0);
    run_phase({inverse_mass, coefficients, Phase::restitution, work, at_least_relative(precision, state), state});
}

ImpactOutcome solve_frictional_impact(const Mat3& inverse_mass, Vec3 velocity, const ImpactCoefficients& coefficients) {
    ImpactState state;
    state.velocity = velocity;
    compress(inverse_mass, coefficients, state);
    ImpactOutcome outcome;
    outcome.compression_impulse = state.impulse.z;
    outcome.compression_velocity = state.velocity;

    const double compression_work = -state.normal_work;
    const double work = coefficients.restitution * coefficients.restitution * compression_work;
    release(inverse_mass, coefficients, work, state, {.stop_speed = stop_fraction * length(velocity)});
    outcome.velocity_after = velocity + inverse_mass * state.impulse;
    outcome.impulse = state.impulse;
    outcome.sticks = state.sticks;
    return outcome;
}

}  // namespace embody::physics::constraint
