// SPDX-License-Identifier: MIT
//
// Joints as bilateral constraints, solved in the two phases of a substep.
// Sources: J.-P. Ryckaert et al., "Numerical integration of the cartesian equations of motion of a system with
// constraints", 1977 (Shake); H. Andersen, "Rattle", 1983. With the Jacobian J of the pose before the drift,
//   position phase:  λ₁ such that C(pose after the drift) = 0      (C itself, not its linearisation)
//   velocity phase:  λ₂ such that J v = 0 at the new pose
// which is symplectic: a pendulum neither gains nor loses energy. The rows of one joint are one block, K = J M⁻¹ Jᵀ.
#include "physics/constraint/joint.h"

#include <algorithm>
#include <cmath>

#include "math/arc_tangent.h"
#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics {

JointImpulses& impulses_of(Joint& joint, SolvePhase phase) {
    return phase == SolvePhase::position ? joint.position_phase : joint.velocity_phase;
}

namespace {

const BodyState world_body{};

const BodyState& body_a(const Joint& joint, std::span<const BodyState> bodies) {
    return joint.a_is_world ? world_body : bodies[joint.a];
}

// The two joint frames in the world.
struct Frames {
    Transform a, b;
};

Frames frames_now(const Joint& joint, std::span<const BodyState> bodies) {
    const BodyState& a = body_a(joint, bodies);
    const BodyState& b = bodies[joint.b];
    return {Transform{a.center, a.rotation} * joint.local_a, Transform{b.center, b.rotation} * joint.local_b};
}

Transform after_drift(const BodyState& body, double time) {
    return {body.center + body.linear_velocity * time,
            normalized(cayley(body.angular_velocity * time) * body.rotation)};
}

Frames frames_after_drift(const Joint& joint, double time, std::span<const BodyState> bodies) {
    const Transform a = joint.a_is_world ? Transform{} : after_drift(bodies[joint.a], time);
    return {a * joint.local_a, after_drift(bodies[joint.b], time) * joint.local_b};
}

template <class Kind>
bool is(const Joint& joint) {
    return std::holds_alternative<Kind>(joint.kind);
}

Vec3 axis_of(const Transform& frame, int i) {
    return rotate(frame.rotation, i == 0 ? Vec3{1, 0, 0} : i == 1 ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
}

// Small rotation vector that takes frame a to frame b.
Vec3 rotation_error(const Frames& frames) {
    const Quat q = frames.b.rotation * conjugate(frames.a.rotation);
    return Vec3{q.x, q.y, q.z} * (q.w < 0 ? -2.0 : 2.0);
}

// C(pose), one number a row, in the order of prepare_joint().
std::array<double, max_joint_rows> constraint_errors(const Joint& joint, const Frames& frames) {
    const Vec3 gap = frames.b.position - frames.a.position;
    std::array<double, max_joint_rows> errors{};
    if (is<SliderJoint>(joint)) {
        const Vec3 turn = rotation_error(frames);
        errors = {dot(axis_of(frames.a, 1), gap), dot(axis_of(frames.a, 2), gap), turn.x, turn.y, turn.z, 0};
    } else if (is<HingeJoint>(joint)) {
        const Vec3 tilt = cross(axis_of(frames.a, 0), axis_of(frames.b, 0));
        errors = {gap.x, gap.y, gap.z, dot(axis_of(frames.a, 1), tilt), dot(axis_of(frames.a, 2), tilt), 0};
    } else {
        const Vec3 turn = rotation_error(frames);
        errors = {gap.x, gap.y, gap.z, turn.x, turn.y, turn.z};
    }
    return errors;
}

double coordinate_of(const Joint& joint, const Frames& frames) {
    if (is<SliderJoint>(joint)) return dot(axis_of(frames.a, 0), frames.b.position - frames.a.position);
    if (!is<HingeJoint>(joint)) return 0;
    const Quat q = conjugate(frames.a.rotation) * frames.b.rotation;
    return 2 * (q.w < 0 ? arc_tangent(-q.x, -q.w) : arc_tangent(q.x, q.w));
}

// Joints are mended no faster than this: bodies that a user joined far apart come together instead of bursting.
constexpr double fastest_mending = 5;  // m/s or rad/s

// What may be left of an error after a substep.
double rest_of(double error, double substep) {
    const double most = fastest_mending * substep;
    return error - std::clamp(error, -most, most);
}

Vec3 angular_effect(const BodyState& body, Vec3 row) { return body.inverse_inertia * row; }

double row_product(const JointRow& i, const JointRow& j, const BodyState& a, const BodyState& b) {
    return (a.inverse_mass + b.inverse_mass) * dot(i.linear, j.linear) +
           dot(i.angular_a, angular_effect(a, j.angular_a)) + dot(i.angular_b, angular_effect(b, j.angular_b));
}

double row_speed(const Joint& joint, const JointRow& row, std::span<const BodyState> bodies) {
    const BodyState& a = body_a(joint, bodies);
    const BodyState& b = bodies[joint.b];
    return dot(row.linear, b.linear_velocity - a.linear_velocity) + dot(row.angular_b, b.angular_velocity) -
           dot(row.angular_a, a.angular_velocity);
}

void apply_row(const Joint& joint, const JointRow& row, double impulse, std::span<BodyState> bodies) {
    BodyState& b = bodies[joint.b];
    b.linear_velocity += row.linear * (impulse * b.inverse_mass);
    b.angular_velocity += angular_effect(b, row.angular_b * impulse);
    if (joint.a_is_world) return;
    BodyState& a = bodies[joint.a];
    a.linear_velocity -= row.linear * (impulse * a.inverse_mass);
    a.angular_velocity -= angular_effect(a, row.angular_a * impulse);
}

// K = L Lᵀ. Two immovable bodies give a zero K, which leaves the joint without rows.
void factor_block(Joint& joint, const BodyState& a, const BodyState& b) {
    const auto n = static_cast<std::size_t>(joint.row_count);
    auto& l = joint.cholesky;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = row_product(joint.rows[i], joint.rows[j], a, b);
            for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            if (i != j) {
                l[i][j] = sum / l[j][j];
            } else if (sum > 0) {
                l[i][i] = std::sqrt(sum);
            } else {
                joint.row_count = 0;
                return;
            }
        }
    }
}

std::array<double, max_joint_rows> solve_block(const Joint& joint, std::array<double, max_joint_rows> x) {
    const auto n = static_cast<std::size_t>(joint.row_count);
    const auto& l = joint.cholesky;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
        x[i] /= l[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k][i] * x[k];
        x[i] /= l[i][i];
    }
    return x;
}

const std::optional<JointLimit>* limit_of(const Joint& joint) {
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.kind)) return &hinge->limit;
    if (const auto* slider = std::get_if<SliderJoint>(&joint.kind)) return &slider->limit;
    return nullptr;
}

const std::optional<JointMotor>* motor_of(const Joint& joint) {
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.kind)) return &hinge->motor;
    if (const auto* slider = std::get_if<SliderJoint>(&joint.kind)) return &slider->motor;
    return nullptr;
}

void change_free_impulse(Joint& joint, double& impulse, double value, double sign, std::span<BodyState> bodies) {
    const double change = value - impulse;
    impulse = value;
    if (change != 0) apply_row(joint, joint.free_row, sign * change, bodies);
}

void solve_motor(Joint& joint, SolvePhase phase, double substep, std::span<BodyState> bodies) {
    const auto* motor = motor_of(joint);
    if (!motor || !*motor) return;
    double& impulse = impulses_of(joint, phase).motor;
    const double largest = (*motor)->max_force * substep / 2;
    const double missing = (*motor)->speed - row_speed(joint, joint.free_row, bodies);
    change_free_impulse(joint, impulse, std::clamp(impulse + joint.free_mass * missing, -largest, largest), 1, bodies);
}

// Whether a body turns so far in a substep that its pose after the drift tells nothing: the passes would run away. The
// speed of the rows then stands for the way.
bool turns_too_far(const Joint& joint, double substep, std::span<const BodyState> bodies) {
    const double fastest = std::max(length_squared(body_a(joint, bodies).angular_velocity),
                                    length_squared(bodies[joint.b].angular_velocity));
    return fastest * substep * substep > 1;
}

// How fast each row's error grows beyond what may be left of it.
std::array<double, max_joint_rows> position_excess(const Joint& joint, double substep,
                                                   std::span<const BodyState> bodies) {
    std::array<double, max_joint_rows> excess{};
    const bool is_linear = turns_too_far(joint, substep, bodies);
    if (!is_linear) excess = constraint_errors(joint, frames_after_drift(joint, substep, bodies));
    for (std::size_t i = 0; i < max_joint_rows; ++i) {
        if (is_linear) excess[i] = joint.errors[i] + substep * row_speed(joint, joint.rows[i], bodies);
        excess[i] = (excess[i] - rest_of(joint.errors[i], substep)) / substep;
    }
    return excess;
}

// One side of the limit; `sign` is +1 for the lower and −1 for the upper bound.
void solve_bound(Joint& joint, SolvePhase phase, double substep, double bound, double sign,
                 std::span<BodyState> bodies) {
    const bool is_lower = sign > 0;
    const JointImpulses& first = joint.position_phase;
    const double earlier = phase == SolvePhase::velocity ? (is_lower ? first.lower : first.upper) : 0;
    double& impulse = is_lower ? impulses_of(joint, phase).lower : impulses_of(joint, phase).upper;

    // How fast the coordinate leaves the allowed range: by where the drift would take it, or by its speed where it
    // is held already. What the warm start gave to a bound that holds no more is taken back.
    double leaving = 0;
    if (phase == SolvePhase::position) {
        const double now = -sign * (coordinate_of(joint, frames_now(joint, bodies)) - bound);
        const double after = turns_too_far(joint, substep, bodies)
                                 ? now - sign * substep * row_speed(joint, joint.free_row, bodies)
                                 : -sign * (coordinate_of(joint, frames_after_drift(joint, substep, bodies)) - bound);
        leaving = (after - rest_of(std::max(now, 0.0), substep)) / substep;
    } else if (earlier > 0) {
        leaving = -sign * row_speed(joint, joint.free_row, bodies);
    } else {
        change_free_impulse(joint, impulse, 0, sign, bodies);
        return;
    }
    change_free_impulse(joint, impulse, std::max(impulse + joint.free_mass * leaving, -earlier), sign, bodies);
}

void solve_free_row(Joint& joint, SolvePhase phase, double substep, std::span<BodyState> bodies) {
    if (joint.free_mass == 0) return;
    solve_motor(joint, phase, substep, bodies);
    const auto* limit = limit_of(joint);
    if (!limit || !*limit) return;
    solve_bound(joint, phase, substep, (*limit)->lower, 1, bodies);
    solve_bound(joint, phase, substep, (*limit)->upper, -1, bodies);
}

}  // namespace

void prepare_joint(Joint& joint, std::span<const BodyState> bodies) {
    const BodyState& a = body_a(joint, bodies);
    const BodyState& b = bodies[joint.b];
    const Frames frames = frames_now(joint, bodies);
    const Vec3 arm_a = frames.a.position - a.center;
    const Vec3 arm_b = frames.b.position - b.center;
    const auto point_row = [&](Vec3 d) { return JointRow{d, cross(arm_a, d), cross(arm_b, d)}; };
    const auto turn_row = [](Vec3 d) { return JointRow{{}, d, d}; };

    // A slider's directions turn with body a, so a's arm reaches to b's joint point.
    const Vec3 reach_a = frames.b.position - a.center;
    const auto slide_row = [&](Vec3 d) { return JointRow{d, cross(reach_a, d), cross(arm_b, d)}; };

    constexpr Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    const Vec3 axis_x = axis_of(frames.a, 0), axis_y = axis_of(frames.a, 1), axis_z = axis_of(frames.a, 2);
    joint.arm_b = arm_b;
    joint.errors = constraint_errors(joint, frames);
    joint.free_row = {};
    if (is<SliderJoint>(joint)) {
        joint.rows = {slide_row(axis_y), slide_row(axis_z), turn_row(x), turn_row(y), turn_row(z), JointRow{}};
        joint.row_count = 5;
        joint.free_row = slide_row(axis_x);
    } else if (is<HingeJoint>(joint)) {
        joint.rows = {point_row(x), point_row(y), point_row(z), turn_row(axis_y), turn_row(axis_z), JointRow{}};
        joint.row_count = 5;
        joint.free_row = turn_row(axis_x);
    } else {
        joint.rows = {point_row(x), point_row(y), point_row(z), turn_row(x), turn_row(y), turn_row(z)};
        joint.row_count = is<BallJoint>(joint) ? 3 : 6;
    }
    factor_block(joint, a, b);
    const double free_product = row_product(joint.free_row, joint.free_row, a, b);
    joint.free_mass = free_product > 0 ? 1 / free_product : 0;
}

void warm_start_joint(Joint& joint, SolvePhase phase, std::span<BodyState> bodies) {
    const JointImpulses& impulses = impulses_of(joint, phase);
    for (std::size_t i = 0; i < static_cast<std::size_t>(joint.row_count); ++i) {
        apply_row(joint, joint.rows[i], impulses.rows[i], bodies);
    }
    apply_row(joint, joint.free_row, impulses.motor + impulses.lower - impulses.upper, bodies);
}

double solve_joint(Joint& joint, SolvePhase phase, double substep, std::span<BodyState> bodies) {
    solve_free_row(joint, phase, substep, bodies);

    // What each row's speed is too much.
    std::array<double, max_joint_rows> excess{};
    if (phase == SolvePhase::position) {
        excess = position_excess(joint, substep, bodies);
    } else {
        for (std::size_t i = 0; i < max_joint_rows; ++i) excess[i] = row_speed(joint, joint.rows[i], bodies);
    }
    const std::array<double, max_joint_rows> change = solve_block(joint, excess);
    JointImpulses& impulses = impulses_of(joint, phase);
    double largest = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(joint.row_count); ++i) {
        impulses.rows[i] -= change[i];
        apply_row(joint, joint.rows[i], -change[i], bodies);
        largest = std::max(largest, std::fabs(excess[i]));
    }
    return largest;
}

void add_to_totals(Joint& joint, SolvePhase phase) {
    const JointImpulses& impulses = impulses_of(joint, phase);
    Vec3 linear, angular;
    const auto add = [&](const JointRow& row, double impulse) {
        linear += row.linear * impulse;
        angular += row.angular_b * impulse;
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(joint.row_count); ++i) add(joint.rows[i], impulses.rows[i]);
    add(joint.free_row, impulses.motor + impulses.lower - impulses.upper);
    joint.total_linear += linear;
    joint.total_angular += angular - cross(joint.arm_b, linear);
}

double joint_coordinate(const Joint& joint, std::span<const BodyState> bodies) {
    return coordinate_of(joint, frames_now(joint, bodies));
}

}  // namespace embody::physics
