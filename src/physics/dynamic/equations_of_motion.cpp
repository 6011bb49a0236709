// SPDX-License-Identifier: MIT
//
// Lagrange's equations (paper, eq. 2) of a rigid body. With the position of the centre of mass as generalised
// coordinates they are m dv/dt = F; with the rotation's quasi-coordinates they are Euler's equations, in body axes
//     dL/dt = L × ω + τ,   L = I ω.
// Source of the scheme: L. Verlet, "Computer experiments on classical fluids", 1967 (kick, drift, kick); J. Simo and
// K. Wong, "Unconditionally stable algorithms for rigid body dynamics that exactly preserve energy and momentum", 1991.
//
//     L₁ = L₀ + h L_m × ω_m,   L_m = (L₀ + L₁)/2 = I ω_m       (implicit midpoint: keeps |L| and the energy)
//     R₁ = R₀ cay(h ω_m)                                        (keeps R L, the momentum seen from the world)
// The two belong together: cay(hω) = (1 − hω̂/2)⁻¹(1 + hω̂/2) gives R₁ L₁ = R₀ L₀ exactly. So during a drift the world
// momentum is constant and only the inertia turns; and cay leaves ω_m itself fixed, so that R₀ω_m = R₁ω_m is the one
// mean angular velocity for which constraints can be solved between the kick and the drift.
#include "physics/dynamic/equations_of_motion.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::dynamic {

Quat cayley(Vec3 angle) { return normalized(Quat{angle.x / 2, angle.y / 2, angle.z / 2, 1}); }

bool has_gyroscopic_torque(const BodyState& state, const BodyConstants& constants, double time) {
    constexpr double min_turn = 1e-3;  // rad
    return !constants.is_isotropic && length_squared(state.angular_velocity) * time * time > min_turn * min_turn;
}

void refresh_inertia(BodyState& state, const BodyConstants& constants) {
    state.inverse_inertia =
        constants.is_isotropic ? constants.inverse_inertia : rotate_tensor(state.rotation, constants.inverse_inertia);
}

void kick(BodyState& state, const BodyConstants& constants, double time) {
    state.linear_velocity += constants.acceleration * time;
    state.angular_velocity += state.inverse_inertia * (constants.torque * time);

    // Linear damping dv/dt = −c v, implicit so that any c is stable.
    if (constants.linear_damping > 0) state.linear_velocity *= 1 / (1 + time * constants.linear_damping);
    if (constants.angular_damping > 0) state.angular_velocity *= 1 / (1 + time * constants.angular_damping);
}

namespace {

// Solves L_m = L₀ + h/2 L_m × I⁻¹L_m for ω_m = I⁻¹L_m by Newton's method: f(ω) = I ω − L₀ + h/2 ω × I ω.
Vec3 solve_midpoint(const Mat3& inertia, Vec3 start_momentum, Vec3 guess, double time) {
    constexpr int max_iterations = 8;    // of Newton's method
    constexpr double tolerance = 1e-12;  // of the momentum: a day of substeps changes it by 1e-5
    const double half = time / 2;
    Vec3 omega = guess;
    for (int i = 0; i < max_iterations; ++i) {
        const Vec3 momentum = inertia * omega;
        const Vec3 residual = momentum - start_momentum + half * cross(omega, momentum);
        if (length_squared(residual) <= tolerance * tolerance * length_squared(start_momentum)) break;
        const Mat3 derivative = inertia + (skew(omega) * inertia - skew(momentum)) * half;
        omega -= solve(derivative, residual);
    }
    return omega;
}

// Time of the one Cayley turn that equals `parts` turns of time / parts each; 0 beyond five twelfths of a circle.
// tan(n a) follows from the powers of 1 + i tan(a), without a library function.
double time_of_one_turn(double speed, double time, int parts) {
    const double tangent = speed * time / (2 * parts);
    if (tangent == 0) return time;
    double real = 1, imaginary = 0;
    for (int i = 0; i < parts; ++i) {
        const double last = real;
        real -= tangent * imaginary;
        imaginary += tangent * last;
        if (!(imaginary < 3.7 * real)) return 0;
    }
    return 2 * imaginary / (real * speed);
}

// Gives the body the mean velocity (body axes) and stores the rest of its momentum separately.
void hide_momentum(BodyState& state, const BodyConstants& constants, Vec3 mean) {
    const Vec3 omega = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 momentum = constants.inertia * omega, mean_momentum = constants.inertia * mean;
    state.angular_velocity = rotate(state.rotation, mean);
    state.hidden_momentum = rotate(state.rotation, momentum - mean_momentum);
    state.hidden_energy = (dot(omega, momentum) - dot(mean, mean_momentum)) / 2;
}

}  // namespace

void split_gyroscopic(BodyState& state, const BodyConstants& constants, double time) {
    state.hidden_momentum = {};
    if (constants.is_isotropic || state.angular_velocity == Vec3{}) return;
    const Vec3 omega = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 momentum = constants.inertia * omega;
    hide_momentum(state, constants, solve_midpoint(constants.inertia, momentum, omega, time));
}

void split_gyroscopic_of_turns(BodyState& state, const BodyConstants& constants, double time, int parts) {
    state.hidden_momentum = {};
    if (constants.is_isotropic || state.angular_velocity == Vec3{}) return;
    const Vec3 omega = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 momentum = constants.inertia * omega;

    // The time of the one turn depends, weakly, on the mean velocity that is being solved for.
    constexpr int iterations = 3;
    Vec3 mean = omega;
    for (int i = 0; i < iterations; ++i) {
        const double whole = time_of_one_turn(length(mean), time, parts);
        if (whole == 0) return;
        mean = solve_midpoint(constants.inertia, momentum, mean, whole);
    }
    hide_momentum(state, constants, mean);
}

void finish_turn(BodyState& state, const BodyConstants& constants, Quat turn) {
    const Quat before = state.rotation;
    state.turn = turn;
    state.rotation = normalized(turn * state.start_rotation);
    refresh_inertia(state, constants);
    const bool has_hidden = state.hidden_momentum != Vec3{};
    if (constants.is_isotropic) return;

    // In the body's axes: the momentum before the turn, and what is constant in the world during the turn: the
    // momentum, or without the split the velocity.
    const Vec3 mean = rotate_inverse(before, state.angular_velocity), mean_momentum = constants.inertia * mean;
    const Vec3 momentum = mean_momentum + rotate_inverse(before, state.hidden_momentum);
    const Vec3 velocity = has_hidden
                              ? constants.inverse_inertia * rotate_inverse(state.rotation, rotate(before, momentum))
                              : rotate_inverse(state.rotation, state.angular_velocity);
    const double hidden = has_hidden ? 2 * state.hidden_energy : 0;
    const double allowed = std::max(0.0, dot(mean, mean_momentum) + hidden);
    const double energy = dot(velocity, constants.inertia * velocity);
    const double scale = energy > allowed ? std::sqrt(allowed / energy) : 1;
    if (has_hidden || scale < 1) state.angular_velocity = rotate(state.rotation, velocity * scale);
}

Vec3 momentum_of(const BodyState& state, const BodyConstants& constants) {
    const Vec3 omega = rotate_inverse(state.rotation, state.angular_velocity);
    return rotate(state.rotation, constants.inertia * omega) + state.hidden_momentum;
}

void drift(BodyState& state, const BodyConstants& constants, double time) {
    state.center += state.linear_velocity * time;
    if (state.angular_velocity == Vec3{} && state.hidden_momentum == Vec3{}) return;

    // The momentum at the start of the drift, with what the constraints added to it since split_gyroscopic().
    const Vec3 momentum = constants.is_isotropic ? Vec3{} : momentum_of(state, constants);
    state.rotation = normalized(cayley(state.angular_velocity * time) * state.rotation);
    state.turn = state.rotation * conjugate(state.start_rotation);
    refresh_inertia(state, constants);

    // The same momentum gives the turned body another angular velocity.
    if (!constants.is_isotropic) state.angular_velocity = state.inverse_inertia * momentum;
}

namespace {

// Velocity after `time` of an acceleration and of damping, as in kick(); a negative time undoes it.
Vec3 kicked(Vec3 velocity, Vec3 acceleration, double damping, double time) {
    if (time < 0) return velocity * (1 - time * damping) + acceleration * time;
    return (velocity + acceleration * time) * (1 / (1 + time * damping));
}

// The body's angular velocity seen in its own axes, over a turn by the mean velocity ω_m: ω₁ = 2 ω_m − ω₀.
void turn_freely(Quat& rotation, Vec3& omega, const BodyConstants& constants, double time) {
    if (constants.is_isotropic) {
        rotation = normalized(rotation * cayley(omega * time));
        return;
    }
    const Vec3 momentum = constants.inertia * omega;
    const Vec3 guess = omega - constants.inverse_inertia * (cross(omega, momentum) * (time / 2));
    const Vec3 mean = solve_midpoint(constants.inertia, momentum, guess, time);
    rotation = normalized(rotation * cayley(mean * time));
    omega = 2 * mean - omega;
}

}  // namespace

void fly(BodyState& state, const BodyConstants& constants, double time) {
    if (move_freely(state, constants, time)) refresh_inertia(state, constants);
}

bool move_freely(BodyState& state, const BodyConstants& constants, double time) {
    const double half = time / 2;
    const Vec3 acceleration = constants.acceleration;
    state.linear_velocity = kicked(state.linear_velocity, acceleration, constants.linear_damping, half);
    state.center += state.linear_velocity * time;
    state.linear_velocity = kicked(state.linear_velocity, acceleration, constants.linear_damping, half);
    state.hidden_momentum = {};
    const bool is_pushed = constants.torque != Vec3{} || constants.angular_damping > 0;
    if (state.angular_velocity == Vec3{} && !is_pushed) return false;

    // In the body's axes; forwards and backwards alike, as the midpoint rule is symmetric in time. Its error goes with
    // the square of the turn.
    constexpr double widest_turn =
        0.1;                       // rad in a part (validation.SpinningImpact: 1.2 % off at 50 rad/s without parts)
    constexpr int max_parts = 16;  // of a substep: enough to 400 rad/s; beyond, energy is kept, phase is not
    Quat rotation = state.rotation;
    Vec3 omega = rotate_inverse(rotation, state.angular_velocity);
    const auto push = [&] {
        if (!is_pushed) return;
        const Vec3 angular = constants.inverse_inertia * rotate_inverse(rotation, constants.torque);
        omega = kicked(omega, angular, constants.angular_damping, half);
    };
    const double turn = constants.is_isotropic ? 0 : length(omega) * std::fabs(time);
    const int parts = static_cast<int>(std::min(1 + turn / widest_turn, double{max_parts}));
    push();
    for (int i = 0; i < parts; ++i) turn_freely(rotation, omega, constants, time / parts);
    push();
    state.rotation = rotation;
    state.turn = rotation * conjugate(state.start_rotation);
    state.angular_velocity = rotate(rotation, omega);
    return true;
}

void drift_kinematic(BodyState& state, double time) {
    state.center += state.linear_velocity * time;
    if (state.angular_velocity == Vec3{}) return;
    state.rotation = normalized(cayley(state.angular_velocity * time) * state.rotation);
    state.turn = state.rotation * conjugate(state.start_rotation);
}

}  // namespace embody::physics::dynamic
