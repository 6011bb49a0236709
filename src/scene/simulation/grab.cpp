// SPDX-License-Identifier: MIT
// A point of a body is pulled as by a damped harmonic oscillator: a = ω² (target − p) − 2 ω v, critical damping. The
// force is K⁻¹ a with K = 1/m − [r]× I⁻¹ [r]× (the inverse of the effective mass of the point; Baraff and Witkin,
// 1998), so that a long lever arm gets no jerk.
#include "scene/simulation/grab.h"

#include <cmath>

namespace embody::scene {

namespace {

constexpr double frequency = 12;          // ω, rad/s: reaches the target in a third of a second
constexpr double spin_damping = 8;        // 1/s
constexpr double max_acceleration = 400;  // m/s²: limits the pull towards a far target

}  // namespace

void pull(physics::World& world, const Grab& grab) {
    if (!world.contains(grab.body) || std::isinf(world.mass(grab.body))) return;
    const Transform pose = world.pose(grab.body);
    const Vec3 center = world.center_of_mass(grab.body);
    const Vec3 point = transform_point(pose, grab.local_point);
    const Vec3 arm = point - center;
    const Vec3 spin = world.angular_velocity(grab.body);
    const Vec3 velocity = world.linear_velocity(grab.body) + cross(spin, arm);

    // The acceleration by the spring at the end of the step.
    const double h = world.settings().time_step;
    const double stiffness = frequency * frequency;
    const double damping = 2 * frequency + stiffness * h;
    Vec3 wanted = (stiffness * (grab.target - point) - damping * velocity) / (1 + damping * h);
    const double size = length(wanted);
    if (size > max_acceleration) wanted *= max_acceleration / size;

    // The force with that acceleration on this body at this lever arm.
    const double mass = world.mass(grab.body);
    const Mat3 inertia = rotate_tensor(pose.rotation, world.inertia(grab.body));
    const Mat3 r = skew(arm);
    const Mat3 mobility = Mat3::identity() * (1 / mass) - r * inverse_or_zero(inertia) * r;
    const Mat3 held = inertia + (Mat3::identity() * dot(arm, arm) - outer(arm, arm)) * mass;
    const Vec3 torque = held * spin * -spin_damping;
    const Vec3 gravity = world.settings().gravity * world.body(grab.body)->gravity_factor;
    const Vec3 free = gravity + cross(spin, cross(spin, arm)) + cross(solve(inertia, torque), arm);
    const Vec3 force = solve(mobility, wanted - free);
    if (!is_finite(force) || !is_finite(torque)) return;

    // The handle was checked, the numbers are finite: the world refuses nothing here.
    (void)world.wake(grab.body).ok();
    (void)world.apply_force(grab.body, force, point).ok();
    (void)world.apply_angular_impulse(grab.body, torque * h).ok();
}

}  // namespace embody::scene
