// SPDX-License-Identifier: MIT
// A point p of a body follows a hand as a critically damped oscillator, evaluated at the end of the step h:
//
//   a = [ω² e + (2 ω + ω² h) (u − v)] / (1 + 2 ω h + ω² h²)      e = target − p, u and v the hand's and p's velocity
//
// The damper works on the difference of the velocities, so that nothing lags behind a hand that moves steadily, and
// what is let go leaves with the hand's velocity. The hand's force and torque at the lever arm r:
//
//   F = K⁻¹ (a − g − ω × (ω × r) − (I⁻¹ T) × r)      K = 1/m − [r]× I⁻¹ [r]×
//   T = I α − r × m (a − α × r − ω × (ω × r) − g)    where the hand turns it: α has the form of a
//   T = −c (I + m (r² − r rᵀ)) ω                     where it hangs from the hand: its swing is damped
//   |F| <= strength, weight included,  |T| <= strength · hand breadth
//
// K is the inverse of the effective mass (Baraff and Witkin, 1998), so that a long lever arm gets no jerk; F follows
// from the T that is left within its limit, so that the point moves as wanted though the body does not turn as wanted.
// Of n hands at one body each does the n-th part: the mean of such steps is no longer than the longest of them. Force
// and torque act through the whole step, so that the turn in it is limited too.
#include "scene/simulation/grab.h"

#include <algorithm>
#include <cmath>

namespace embody::scene {

namespace {

constexpr double path_time = 0.05;     // s, over which a hand's velocity is measured: some reports of a tracker
constexpr double max_silence = 0.25;   // s: of reports further apart nobody knows what was between them
constexpr double max_jump = 1;         // m between reports: beyond, the hand was put elsewhere
constexpr double max_hand_speed = 20;  // m/s: of a fast throw; faster is an error of the tracker
constexpr double max_hand_spin = 40;   // rad/s: of a quick turn of the wrist
constexpr double closing_spin = 15;    // rad/s, at which something far from its target rotation turns there at most
constexpr double max_turn = 0.5;       // rad a step: beyond, a lever arm at its beginning tells nothing of its end
constexpr double hanging_damping = 8;  // 1/s, of the swing of what hangs from a hand
/// Lever arm of the couple of forces that a palm exerts: the breadth of a hand, m (British men, 50th percentile:
/// S. Pheasant, "Bodyspace", 2nd ed., 1996, table 2.5).
constexpr double hand_breadth = 0.085;

Vec3 limited(Vec3 v, double max_length) {
    const double size = length(v);
    return size > max_length ? v * (max_length / size) : v;
}

// Axis times angle of the shorter of the two turns.
Vec3 rotation_vector(Quat q) {
    const Vec3 axis = Vec3{q.x, q.y, q.z} * (q.w < 0 ? -1.0 : 1.0);
    const double sine = length(axis);
    return sine > 1e-12 ? axis * (2 * std::atan2(sine, std::fabs(q.w)) / sine) : 2.0 * axis;
}

// The held body in the step, world axes.
struct Held {
    double mass;    // kg
    Mat3 inertia;   // about the centre of mass, kg m²
    Vec3 arm;       // from the centre of mass to the held point, m
    Vec3 velocity;  // of the held point, m/s
    Vec3 spin;      // rad/s
    Vec3 gravity;   // m/s²
    double step;    // s
};

// Acceleration of the oscillator at the end of the step.
Vec3 spring(double frequency, double h, Vec3 offset, Vec3 slip) {
    const double stiffness = frequency * frequency, damping = 2 * frequency + stiffness * h;
    return (stiffness * offset + damping * slip) / (1 + damping * h);
}

// The force that gives the point the acceleration, where the hands turn the body by this torque.
Vec3 force_for(const Held& held, Vec3 wanted, Vec3 torque) {
    const Mat3 r = skew(held.arm);
    const Mat3 mobility = Mat3::identity() * (1 / held.mass) - r * inverse_or_zero(held.inertia) * r;
    const Vec3 free =
        held.gravity + cross(held.spin, cross(held.spin, held.arm)) + cross(solve(held.inertia, torque), held.arm);
    return solve(mobility, wanted - free);
}

// The part of a torque that lets the body turn by no more than max_turn in the step, and no faster than it does if it
// turns faster already: the largest s in 0 … 1 with |ω + s Δω| <= max.
double turning_fraction(const Held& held, Vec3 torque) {
    const Vec3 change = solve(held.inertia, torque) * held.step;
    const double max_spin = std::max(max_turn / held.step, length(held.spin));
    const double a = dot(change, change), b = dot(held.spin, change);
    const double c = dot(held.spin, held.spin) - max_spin * max_spin;  // <= 0
    if (!(a + 2 * b + c > 0)) return 1;
    return std::clamp((std::sqrt(std::max(0.0, b * b - a * c)) - b) / a, 0.0, 1.0);
}

// Torque that damps the swing of what hangs from the hand.
Vec3 damping_torque(const Held& held) {
    const Mat3 about_point =
        held.inertia + (Mat3::identity() * dot(held.arm, held.arm) - outer(held.arm, held.arm)) * held.mass;
    return about_point * held.spin * (-hanging_damping / (1 + hanging_damping * held.step));
}

// Torque with which the body turns as wanted while its point moves as wanted.
Vec3 turning_torque(const Held& held, Vec3 wanted, Vec3 wanted_spin, double max_force) {
    const Vec3 of_center =
        wanted - cross(wanted_spin, held.arm) - cross(held.spin, cross(held.spin, held.arm)) - held.gravity;
    return held.inertia * wanted_spin - cross(held.arm, limited(held.mass * of_center, max_force));
}

}  // namespace

void HandPath::report(double time, Vec3 position, Quat rotation) {
    while (!samples_.empty() && samples_.back().time >= time) samples_.pop_back();
    if (!samples_.empty() &&
        (length(position - samples_.back().position) > max_jump || time - samples_.back().time > max_silence))
        samples_.clear();
    samples_.push_back({time, position, rotation});
    while (samples_.size() > 2 && samples_.front().time < time - path_time * (1 + 1e-9)) samples_.pop_front();
}

void HandPath::rest() {
    while (samples_.size() > 1) samples_.pop_front();
}

HandPath::Motion HandPath::at(double time) const {
    const Sample &first = samples_.front(), &last = samples_.back();
    if (samples_.size() < 2) return {last.position, last.rotation, {}, {}};

    // A report that is late by as much again as they are apart does not come: the hand stands.
    double gap = 0;
    for (std::size_t i = 1; i < samples_.size(); ++i) gap = std::max(gap, samples_[i].time - samples_[i - 1].time);
    const double ahead = time - last.time, measured = last.time - first.time;
    if (ahead > std::min(2 * gap, max_silence) + 1e-9) return {last.position, last.rotation, {}, {}};

    const Vec3 velocity = limited((last.position - first.position) / measured, max_hand_speed);
    const Vec3 spin = limited(rotation_vector(last.rotation * conjugate(first.rotation)) / measured, max_hand_spin);
    const Quat turned = from_axis_angle(normalized(spin, {1, 0, 0}), length(spin) * ahead);
    return {last.position + velocity * ahead, normalized(turned * last.rotation), velocity, spin};
}

void pull(physics::World& world, const Grab& grab, int hands_at_body) {
    if (!world.contains(grab.body) || std::isinf(world.mass(grab.body))) return;
    const Transform pose = world.pose(grab.body);
    const Vec3 point = transform_point(pose, grab.local_point);
    Held held{.mass = world.mass(grab.body),
              .inertia = rotate_tensor(pose.rotation, world.inertia(grab.body)),
              .arm = point - world.center_of_mass(grab.body),
              .velocity = {},
              .spin = world.angular_velocity(grab.body),
              .gravity = world.settings().gravity * world.body(grab.body)->gravity_factor,
              .step = world.settings().time_step};
    held.velocity = world.linear_velocity(grab.body) + cross(held.spin, held.arm);

    // What all n hands would do if they were as this one.
    const double w = grab.frequency, h = held.step, strength = hands_at_body * grab.strength;
    const Vec3 offset = limited(grab.target - point, 2 * grab.closing_speed / w);
    const Vec3 wanted = spring(w, h, offset, grab.velocity - held.velocity);
    Vec3 torque;
    if (grab.rotation) {
        const Vec3 angle = limited(rotation_vector(*grab.rotation * conjugate(pose.rotation)), 2 * closing_spin / w);
        torque = turning_torque(held, wanted, spring(w, h, angle, grab.spin - held.spin), strength);
    } else {
        torque = damping_torque(held);
    }
    torque = limited(torque, strength * hand_breadth);
    Vec3 force = limited(force_for(held, wanted, torque), strength);
    torque += cross(held.arm, force);
    torque *= turning_fraction(held, torque) / hands_at_body;
    force *= 1.0 / hands_at_body;
    if (!is_finite(force) || !is_finite(torque)) return;

    // The handle was checked, the numbers are finite: the world refuses nothing here.
    (void)world.wake(grab.body).ok();
    (void)world.apply_force(grab.body, force).ok();
    (void)world.apply_angular_impulse(grab.body, torque * h).ok();
}

}  // namespace embody::scene
