// SPDX-License-Identifier: MIT
//
// Joints as bilateral constraints: their errors C and rows J, and how joints are solved one after the other in the two
// phases of a substep where a list is too long for all at once (joint_system.h). Sources: J.-P. Ryckaert et al.,
// "Numerical integration of the cartesian equations of motion of a system with constraints", 1977 (Shake); H. Andersen,
// "Rattle", 1983. With the Jacobian J of the pose before the drift,
//   position phase:  λ₁ such that C(pose after the drift) = 0      (C itself, not its linearisation)
//   velocity phase:  λ₂ such that J v = 0 at the new pose
// which is symplectic: a pendulum neither gains nor loses energy. The rows of one joint are one block, K = J M⁻¹ Jᵀ.
#include "physics/constraint/joint/joint.h"

#include <algorithm>
#include <cmath>

#include "math/arc_tangent.h"
#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

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

Vec3 axis_of(const Transform& frame, int i) {
    return rotate(frame.rotation, i == 0 ? Vec3{1, 0, 0} : i == 1 ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
}

// Small rotation vector that takes frame a to frame b.
Vec3 rotation_error(const Frames& frames) {
    const Quat q = frames.b.rotation * conjugate(frames.a.rotation);
    return Vec3{q.x, q.y, q.z} * (q.w < 0 ? -2.0 : 2.0);
}

// C(pose) of each kind, one number a row, in the order of rows_of().
using RowErrors = std::array<double, max_joint_rows>;

RowErrors errors_of(const FixedJoint&, const Frames& frames) {
    const Vec3 gap = frames.b.position - frames.a.position, turn = rotation_error(frames);
    return {gap.x, gap.y, gap.z, turn.x, turn.y, turn.z};
}

RowErrors errors_of(const BallJoint&, const Frames& frames) {
    const Vec3 gap = frames.b.position - frames.a.position;
    return {gap.x, gap.y, gap.z};
}

RowErrors errors_of(const HingeJoint&, const Frames& frames) {
    const Vec3 gap = frames.b.position - frames.a.position, axis_b = axis_of(frames.b, 0);
    return {gap.x, gap.y, gap.z, -dot(axis_of(frames.a, 2), axis_b), dot(axis_of(frames.a, 1), axis_b)};
}

RowErrors errors_of(const SliderJoint&, const Frames& frames) {
    const Vec3 gap = frames.b.position - frames.a.position, turn = rotation_error(frames);
    return {dot(axis_of(frames.a, 1), gap), dot(axis_of(frames.a, 2), gap), turn.x, turn.y, turn.z};
}

RowErrors constraint_errors(const Joint& joint, const Frames& frames) {
    return std::visit([&](const auto& kind) { return errors_of(kind, frames); }, joint.kind);
}

JointGeometry geometry_of(const Frames& frames, Vec3 center_a, Vec3 center_b) {
    return {frames.a.position - center_a, frames.b.position - center_b, frames.b.position - center_a,
            axis_of(frames.a, 0),         axis_of(frames.a, 1),         axis_of(frames.a, 2),
            axis_of(frames.b, 0)};
}

double angle_about_x(const Frames& frames) {
    const Quat q = conjugate(frames.a.rotation) * frames.b.rotation;
    return 2 * (q.w < 0 ? arc_tangent(-q.x, -q.w) : arc_tangent(q.x, q.w));
}

double coordinate_of(const Joint& joint, const Frames& frames) {
    return std::visit(
        [&]<class Kind>(const Kind&) -> double {
            if constexpr (!HasCoordinate<Kind>)
                return 0;
            else if constexpr (Kind::turns)
                return angle_about_x(frames);
            else
                return dot(axis_of(frames.a, 0), frames.b.position - frames.a.position);
        },
        joint.kind);
}

Vec3 angular_effect(const BodyState& body, Vec3 row) { return body.inverse_inertia * row; }

double row_product(const JointRow& i, const JointRow& j, const BodyState& a, const BodyState& b) {
    return (a.inverse_mass + b.inverse_mass) * dot(i.linear, j.linear) +
           dot(i.angular_a, angular_effect(a, j.angular_a)) + dot(i.angular_b, angular_effect(b, j.angular_b));
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

void change_free_impulse(Joint& joint, double& impulse, double value, double sign, std::span<BodyState> bodies) {
    const double change = value - impulse;
    impulse = value;
    if (change != 0) apply_row(joint, joint.free_row, sign * change, bodies);
}

void solve_motor(Joint& joint, const JointPhase& phase, std::span<BodyState> bodies) {
    const auto* motor = motor_of(joint.kind);
    if (!motor || !*motor) return;
    double& impulse = impulses_of(joint, phase.phase).motor;
    const double largest = (*motor)->max_force * phase.substep / 2;
    const double missing = (*motor)->speed - row_speed(joint, joint.free_row, bodies);
    change_free_impulse(joint, impulse, std::clamp(impulse + joint.free_mass * missing, -largest, largest), 1, bodies);
}

// Whether a body turns so far in a substep that its pose after the drift is useless: the passes would diverge. The
// speed of the rows is then used in place of the displacement.
bool turns_too_far(const Joint& joint, const JointPhase& phase, std::span<const BodyState> bodies) {
    const double fastest = std::max(length_squared(body_a(joint, bodies).angular_velocity),
                                    length_squared(bodies[joint.b].angular_velocity));
    const double max_turn = phase.settings.max_drift_turn;
    return fastest * phase.substep * phase.substep > max_turn * max_turn;
}

// How fast each row's error grows beyond what may be left of it.
std::array<double, max_joint_rows> position_excess(const Joint& joint, const JointPhase& phase,
                                                   std::span<const BodyState> bodies) {
    const double substep = phase.substep, max_correction = phase.max_correction();
    std::array<double, max_joint_rows> excess{};
    const bool is_linear = turns_too_far(joint, phase, bodies);
    if (!is_linear) excess = constraint_errors(joint, frames_after_drift(joint, substep, bodies));
    for (std::size_t i = 0; i < max_joint_rows; ++i) {
        if (is_linear) excess[i] = joint.errors[i] + substep * row_speed(joint, joint.rows[i], bodies);
        excess[i] = (excess[i] - rest_of_error(joint.errors[i], max_correction)) / substep;
    }
    return excess;
}

// One side of a limit.
struct Bound {
    double value;  // of the joint coordinate
    double sign;   // +1 for the lower, −1 for the upper one
};

std::array<Bound, 2> bounds_of(const JointLimit& limit) { return {{{limit.lower, 1}, {limit.upper, -1}}}; }

double& impulse_of(JointImpulses& impulses, const Bound& bound) {
    return bound.sign > 0 ? impulses.lower : impulses.upper;
}

// The velocity phase may take back the bound's impulse of the position phase.
double earlier_impulse(Joint& joint, SolvePhase phase, const Bound& bound) {
    return phase == SolvePhase::velocity ? impulse_of(joint.position_phase, bound) : 0;
}

// How fast the coordinate leaves the allowed range: by where the drift would take it, or by its speed.
double leaving_speed(const Joint& joint, const JointPhase& phase, const Bound& bound,
                     std::span<const BodyState> bodies) {
    const double speed = -bound.sign * row_speed(joint, joint.free_row, bodies), substep = phase.substep;
    if (phase.phase == SolvePhase::velocity) return speed;
    const auto beyond = [&](const Frames& frames) {
        return -bound.sign * (coordinate_of(joint, frames) - bound.value);
    };
    const double now = beyond(frames_now(joint, bodies));
    const double after = turns_too_far(joint, phase, bodies) ? now + substep * speed
                                                             : beyond(frames_after_drift(joint, substep, bodies));
    return (after - rest_of_error(std::max(now, 0.0), phase.max_correction())) / substep;
}

void solve_bound(Joint& joint, const JointPhase& phase, const Bound& bound, std::span<BodyState> bodies) {
    const double earlier = earlier_impulse(joint, phase.phase, bound);
    double& impulse = impulse_of(impulses_of(joint, phase.phase), bound);

    // The warm start's impulse of a bound that no longer holds is taken back.
    if (phase.phase == SolvePhase::velocity && !(earlier > 0)) {
        change_free_impulse(joint, impulse, 0, bound.sign, bodies);
        return;
    }
    const double leaving = leaving_speed(joint, phase, bound, bodies);
    change_free_impulse(joint, impulse, std::max(impulse + joint.free_mass * leaving, -earlier), bound.sign, bodies);
}

void solve_free_row(Joint& joint, const JointPhase& phase, std::span<BodyState> bodies) {
    if (joint.free_mass == 0) return;
    solve_motor(joint, phase, bodies);
    const auto* limit = limit_of(joint.kind);
    if (!limit || !*limit) return;
    for (const Bound& bound : bounds_of(**limit)) solve_bound(joint, phase, bound, bodies);
}

}  // namespace

JointGeometry mean_of(const JointGeometry& first, const JointGeometry& second) {
    const auto mean = [](Vec3 p, Vec3 q) { return (p + q) * 0.5; };
    return {mean(first.arm_a, second.arm_a),  mean(first.arm_b, second.arm_b), mean(first.reach_a, second.reach_a),
            mean(first.x, second.x),          mean(first.y, second.y),         mean(first.z, second.z),
            mean(first.axis_b, second.axis_b)};
}

JointPose pose_joint(const Joint& joint, const Transform& a, const Transform& b) {
    const Frames frames{a * joint.local_a, b * joint.local_b};
    return {geometry_of(frames, a.position, b.position), constraint_errors(joint, frames)};
}

namespace {

constexpr Vec3 world_x{1, 0, 0}, world_y{0, 1, 0}, world_z{0, 0, 1};

JointRow point_row(const JointGeometry& g, Vec3 d) { return {d, cross(g.arm_a, d), cross(g.arm_b, d)}; }
JointRow slide_row(const JointGeometry& g, Vec3 d) { return {d, cross(g.reach_a, d), cross(g.arm_b, d)}; }
JointRow turn_row(Vec3 d) { return {{}, d, d}; }

JointRows rows_of(const FixedJoint&, const JointGeometry& g) {
    return {6,
            {point_row(g, world_x), point_row(g, world_y), point_row(g, world_z), turn_row(world_x), turn_row(world_y),
             turn_row(world_z)},
            {}};
}

JointRows rows_of(const BallJoint&, const JointGeometry& g) {
    return {3, {point_row(g, world_x), point_row(g, world_y), point_row(g, world_z)}, {}};
}

JointRows rows_of(const HingeJoint&, const JointGeometry& g) {
    return {5,
            {point_row(g, world_x), point_row(g, world_y), point_row(g, world_z), turn_row(cross(g.z, g.axis_b)),
             turn_row(cross(g.axis_b, g.y))},
            turn_row(g.x)};
}

JointRows rows_of(const SliderJoint&, const JointGeometry& g) {
    return {5,
            {slide_row(g, g.y), slide_row(g, g.z), turn_row(world_x), turn_row(world_y), turn_row(world_z)},
            slide_row(g, g.x)};
}

}  // namespace

// With the mean geometry of two poses these are discrete gradients: the rows times the way between the poses are the
// difference of the errors, exactly so for points and hinges, whose errors are bilinear in what the bodies carry, and
// for directions that turn together.
JointRows make_rows(const Joint& joint, const JointGeometry& geometry) {
    return std::visit([&](const auto& kind) { return rows_of(kind, geometry); }, joint.kind);
}

void set_rows(Joint& joint, const JointGeometry& geometry) {
    const JointRows rows = make_rows(joint, geometry);
    joint.row_count = rows.count;
    joint.rows = rows.rows;
    joint.free_row = rows.free_row;
    joint.arm_b = geometry.arm_b;
}

bool has_motor(const Joint& joint) {
    const auto* motor = motor_of(joint.kind);
    return motor && *motor;
}

bool has_limit(const Joint& joint) {
    const auto* limit = limit_of(joint.kind);
    return limit && *limit;
}

double row_response(const Joint& joint, const JointRow& row, std::span<const BodyState> bodies) {
    return row_product(row, row, body_a(joint, bodies), bodies[joint.b]);
}

double row_speed(const Joint& joint, const JointRow& row, std::span<const BodyState> bodies) {
    const BodyState& a = body_a(joint, bodies);
    const BodyState& b = bodies[joint.b];
    return dot(row.linear, b.linear_velocity - a.linear_velocity) + dot(row.angular_b, b.angular_velocity) -
           dot(row.angular_a, a.angular_velocity);
}

double rest_of_error(double error, double max_correction) {
    return error - std::clamp(error, -max_correction, max_correction);
}

void prepare_joint(Joint& joint, std::span<const BodyState> bodies) {
    const BodyState& a = body_a(joint, bodies);
    const BodyState& b = bodies[joint.b];
    const JointPose pose = pose_joint(joint, {a.center, a.rotation}, {b.center, b.rotation});
    joint.errors = pose.errors;
    set_rows(joint, pose.geometry);
    const double free_product = row_response(joint, joint.free_row, bodies);
    joint.free_mass = free_product > 0 ? 1 / free_product : 0;
}

void factor_joint(Joint& joint, std::span<const BodyState> bodies) {
    factor_block(joint, body_a(joint, bodies), bodies[joint.b]);
}

void warm_start_joint(Joint& joint, SolvePhase phase, std::span<BodyState> bodies) {
    const JointImpulses& impulses = impulses_of(joint, phase);
    for (std::size_t i = 0; i < static_cast<std::size_t>(joint.row_count); ++i) {
        apply_row(joint, joint.rows[i], impulses.rows[i], bodies);
    }
    apply_row(joint, joint.free_row, impulses.motor + impulses.lower - impulses.upper, bodies);
}

double solve_joint(Joint& joint, const JointPhase& phase, std::span<BodyState> bodies) {
    solve_free_row(joint, phase, bodies);

    // By how much each row's speed is too large.
    std::array<double, max_joint_rows> excess{};
    if (phase.phase == SolvePhase::position) {
        excess = position_excess(joint, phase, bodies);
    } else {
        for (std::size_t i = 0; i < max_joint_rows; ++i) excess[i] = row_speed(joint, joint.rows[i], bodies);
    }
    const std::array<double, max_joint_rows> change = solve_block(joint, excess);
    JointImpulses& impulses = impulses_of(joint, phase.phase);
    double largest = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(joint.row_count); ++i) {
        impulses.rows[i] -= change[i];
        apply_row(joint, joint.rows[i], -change[i], bodies);
        largest = std::max(largest, std::fabs(excess[i]));
    }
    return largest;
}

// Primal-dual active set: M. Hintermüller, K. Ito, K. Kunisch, "The primal-dual active set strategy as a semismooth
// Newton method", 2003. A bound holds where its impulse and what the free row alone would add against the speed out of
// the allowed range have a positive sum; a motor drives where that sum is within its force.
double choose_free_hold(Joint& joint, const JointPhase& phase, bool is_first, std::span<BodyState> bodies) {
    JointImpulses& impulses = impulses_of(joint, phase.phase);
    const FreeHold last = impulses.hold;
    impulses.hold = FreeHold::nothing;
    if (joint.free_mass == 0) return 0;
    double excess = 0;

    // Limits.
    const auto* limit = limit_of(joint.kind);
    if (limit && *limit) {
        for (const Bound& bound : bounds_of(**limit)) {
            const FreeHold side = bound.sign > 0 ? FreeHold::lower : FreeHold::upper;
            double& impulse = impulse_of(impulses, bound);
            const double earlier = earlier_impulse(joint, phase.phase, bound);
            const bool is_bound = phase.phase == SolvePhase::position || earlier > 0;
            const bool may_hold = impulses.hold == FreeHold::nothing && is_bound;
            const double leaving = may_hold ? leaving_speed(joint, phase, bound, bodies) : 0;
            const bool goes_on = is_first && last == side;
            if (may_hold && (goes_on || impulse + joint.free_mass * leaving > -earlier)) {
                impulses.hold = side;
                excess = -bound.sign * leaving;
            } else {
                change_free_impulse(joint, impulse, -earlier, bound.sign, bodies);
            }
        }
    }

    // Motor. What a bound holds it only pushes.
    const auto* motor = motor_of(joint.kind);
    if (!motor || !*motor) return excess;
    const double largest = (*motor)->max_force * phase.substep / 2;
    const double too_fast = row_speed(joint, joint.free_row, bodies) - (*motor)->speed;
    const double wanted = impulses.motor - joint.free_mass * too_fast;
    const bool drives = std::fabs(wanted) < largest || (is_first && last == FreeHold::motor);
    if (impulses.hold == FreeHold::nothing && drives) {
        impulses.hold = FreeHold::motor;
        return too_fast;
    }
    change_free_impulse(joint, impulses.motor, std::clamp(wanted, -largest, largest), 1, bodies);
    return excess;
}

void add_free_impulse(Joint& joint, SolvePhase phase, double change) {
    JointImpulses& impulses = impulses_of(joint, phase);
    if (impulses.hold == FreeHold::motor) impulses.motor += change;
    if (impulses.hold == FreeHold::lower) impulses.lower += change;
    if (impulses.hold == FreeHold::upper) impulses.upper -= change;
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

void forget_impulses(Joint& joint) {
    joint.position_phase = joint.velocity_phase = {};
    joint.total_linear = joint.total_angular = {};
}

double joint_coordinate(const Joint& joint, std::span<const BodyState> bodies) {
    return coordinate_of(joint, frames_now(joint, bodies));
}

}  // namespace embody::physics::constraint
