// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/touched_body.h"

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::deformable {

Mat3 TouchedBody::rotation_on_path(double time, Vec3 off) const {
    return to_matrix(cayley(time * path_turn + bend(time) * path_spin_up + off));
}

Vec3 TouchedBody::displacement(double h, double time, Vec3 arm) const {
    const double off = time - (step_time + h) / 2;
    const Vec3 linear = path_velocity + off * path_acceleration + velocity;
    const Vec3 angular = path_spin + off * path_spin_up + spin;
    return h * (linear + cross(angular, arm));
}

void TouchedBody::enter_substep(double h) {
    velocity -= (inverse_mass * h) * expected_force;
    spin -= inverse_inertia * (h * expected_torque);
    shift += h * velocity;
    turn += h * spin;
}

void TouchedBody::enter_whole_step(int substeps) {
    const double n = substeps, rest = (1 - (n + 1) / (2 * n)) * step_time * step_time;
    shift -= (inverse_mass * rest) * expected_late_force;
    turn -= inverse_inertia * (rest * expected_late_torque);
}

void TouchedBody::push(Vec3 given, Vec3 arm, double h) {
    if (!is_dynamic) return;
    const Vec3 faster = inverse_mass * given;
    velocity += faster;
    shift += h * faster;
    impulse += given;
    push_turn(cross(arm, given), h);
}

void TouchedBody::push_turn(Vec3 given, double h) {
    if (!is_dynamic) return;
    const Vec3 turning = inverse_inertia * given;
    spin += turning;
    turn += h * turning;
    angular_impulse += given;
}

PartPushes::PartPushes(std::span<const TouchedBody> bodies) {
    for (const TouchedBody& body : bodies) velocities_.emplace_back(body.velocity, body.spin);
}

void PartPushes::go_on(std::span<TouchedBody> bodies, double h) const {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        bodies[b].shift += h * (bodies[b].velocity - velocities_[b].first);
        bodies[b].turn += h * (bodies[b].spin - velocities_[b].second);
    }
}

}  // namespace embody::physics::deformable
