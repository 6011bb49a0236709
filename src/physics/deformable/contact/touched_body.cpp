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

void TouchedBody::set_borne_forces() {
    for (const BodySupport& support : supports) {
        borne_force -= support.path_force;
        borne_torque -= cross(support.anchor, support.path_force);
    }
}

void TouchedBody::enter_substep(double h) {
    is_off_path = is_pushed_on_path();
    is_settled = false;
    for (BodySupport& support : supports) {
        support.past_impulse += h * support.given;
        support.given = is_off_path ? Vec3{} : support.path_force;
    }
    if (is_off_path) {
        velocity -= (inverse_mass * h) * (expected_force + borne_force);
        spin -= inverse_inertia * (h * (expected_torque + borne_torque));
    }
    shift += h * velocity;
    turn += h * spin;
}

void TouchedBody::enter_whole_step(int substeps) {
    const double n = substeps, rest = (1 - (n + 1) / (2 * n)) * step_time * step_time;
    Vec3 late_force = expected_late_force, late_torque = expected_late_torque;
    const bool was_late = late_force != Vec3{} || late_torque != Vec3{};
    is_settled = false;
    for (BodySupport& support : supports) {
        support.given = (support.past_impulse + step_time / n * support.given) / step_time;
        if (!was_late) continue;
        late_force -= support.path_force - support.given;
        late_torque -= cross(support.anchor, support.path_force - support.given);
    }
    shift -= (inverse_mass * rest) * late_force;
    turn -= inverse_inertia * (rest * late_torque);
}

Vec3 TouchedBody::path_displacement(double time, Vec3 anchor, bool turns) const {
    const Vec3 moved = time * path_velocity + bend(time) * path_acceleration;
    // A body that rolls turns under its point, one that tips lifts it.
    const Vec3 turned = time * path_turn + bend(time) * path_spin_up;
    return moved + (turns ? rotation_on_path(time, {}) * anchor - anchor : cross(turned, anchor));
}

void TouchedBody::move(Vec3 given, Vec3 given_turn, double h) {
    const Vec3 faster = inverse_mass * given, turning = inverse_inertia * given_turn;
    velocity += faster;
    shift += h * faster;
    spin += turning;
    turn += h * turning;
}

void TouchedBody::push(Vec3 given, Vec3 arm, double h) {
    if (!is_dynamic) return;
    move(given, cross(arm, given), h);
    impulse += given;
    angular_impulse += cross(arm, given);
}

void TouchedBody::push_turn(Vec3 given, double h) {
    if (!is_dynamic) return;
    move({}, given, h);
    angular_impulse += given;
}

void TouchedBody::bear(Vec3 given, Vec3 arm, double h) {
    move(given, cross(arm, given), h);
    is_settled = is_open = true;
}

void TouchedBody::close_supports(double h) {
    if (!is_open) return;
    is_open = false;
    for (BodySupport& support : supports) {
        support.given = support.impulse / h;
        support.impulse = {};
    }
}

void TouchedBody::return_to_part(double h, double part) {
    shift -= (h - part) * velocity;
    turn -= (h - part) * spin;
}

void TouchedBody::enter_part(double part) {
    shift += part * velocity;
    turn += part * spin;
}

}  // namespace embody::physics::deformable
