// SPDX-License-Identifier: MIT
//
// The equations of docs/physics/joints.md and Newton's method for them. One iteration solves
//
//   (  A   −J̄ᵀ ) (Δv)   ( −R )      R: what is missing in the equations of motion
//   ( −J₁  −E  ) (Δλ) = (  e )      e: by how much the speed of each row is too large
//
// Sources: D. Baraff, "Linear-time dynamics using Lagrange multipliers", 1996 (multipliers as unknowns: from the leaves
// of a tree inwards nothing fills in, and nothing cancels whatever the masses); O. Gonzalez, "Mechanical systems
// subject to holonomic constraints: differential-algebraic formulations and conservative integration", 1999 (discrete
// gradients). E is tiny. It keeps the matrix regular where rows are redundant (loops of hinges); the next iteration
// corrects the error that it makes.
#include "physics/constraint/joint/joint_system.h"

#include <algorithm>
#include <cmath>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

// What a rotation by the Cayley transform of h (ω + δω) is more than that of h ω, as a row for δω: with a = h ω / 2,
// φ = h (δω + a × δω) / (1 + a²).
Vec3 row_of_turning(Vec3 row, Vec3 half_turn) {
    return (row - cross(half_turn, row)) / (1 + length_squared(half_turn));
}

// (1 − a×)⁻¹
Mat3 inverse_of_turning(Vec3 a) { return (Mat3::identity() + outer(a, a) + skew(a)) * (1 / (1 + length_squared(a))); }

void clear_impulses(JointImpulses& impulses) { impulses = {.hold = impulses.hold}; }

JointRow opposite(const JointRow& row) { return {-row.linear, -row.angular_a, -row.angular_b}; }

}  // namespace

void JointSystem::set(const JointedList& list, const View& view) {
    bodies_.resize(list.bodies.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].slot = list.bodies[i];
    const auto number_of = [&](std::uint32_t slot) -> std::int32_t {
        const auto found = std::ranges::lower_bound(list.bodies, slot);
        if (found == list.bodies.end() || *found != slot) return -1;
        return static_cast<std::int32_t>(found - list.bodies.begin());
    };
    bool is_known = analysed_bodies_ == bodies_.size() && ends_.size() == list.joints.size();
    places_.resize(list.joints.size());
    ends_.resize(places_.size());
    edges_.clear();
    carriers_.clear();
    has_motor_ = false;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        // Bodies first, then the joints; a joint is next to its bodies.
        const Joint& joint = view.joints[list.joints[i]];
        Place& place = places_[i];
        place.joint = list.joints[i];
        place.a = joint.a_is_world ? -1 : number_of(joint.a);
        place.b = number_of(joint.b);
        is_known = is_known && ends_[i] == std::array{place.a, place.b};
        ends_[i] = {place.a, place.b};
        const auto add_edge = [&](std::int32_t body) {
            const auto edge = static_cast<std::uint32_t>(edges_.size());
            const auto node = static_cast<std::uint16_t>(bodies_.size() + i);
            if (body >= 0) edges_.push_back({node, static_cast<std::uint16_t>(body)});
            return edge;
        };
        has_motor_ = has_motor_ || has_motor(joint);
        if (place.a < 0 && !joint.a_is_world) carriers_.push_back(joint.a);
        if (place.b < 0) carriers_.push_back(joint.b);
        place.edge_a = add_edge(place.a);
        place.edge_b = add_edge(place.b);
    }
    std::sort(carriers_.begin(), carriers_.end());
    carriers_.erase(std::unique(carriers_.begin(), carriers_.end()), carriers_.end());
    starts_.resize(static_cast<std::size_t>(view.settings.max_halvings) + 1);
    find_spin_axes(view);
    if (is_known) return;
    analysed_bodies_ = bodies_.size();
    matrix_.analyse(bodies_.size() + places_.size(), edges_, places_.size());
    unknowns_.resize(bodies_.size() + places_.size());
}

void JointSystem::begin_phase(SolvePhase phase, double substep, Motion motion, const View& view) {
    phase_ = phase;
    substep_ = substep;
    is_linear_ = motion == Motion::small;
    is_first_ = true;
    has_factors_ = false;
    last_error_ = 0;
    for (Body& body : bodies_) {
        const BodyState& state = view.bodies[body.slot];
        const BodyConstants& c = view.constants[body.slot];
        body.has_gyroscopic_torque = phase == SolvePhase::position && (!c.is_isotropic || body.own_spin.rate != 0);
        body.turning = Mat3::zero();
        body.inertia = c.is_isotropic ? c.inertia : rotate_tensor(state.rotation, c.inertia);
        body.free_velocity = body.last_velocity = state.linear_velocity;
        body.free_spin = body.last_spin = state.angular_velocity;
        if (body.has_gyroscopic_torque) body.free_momentum = momentum_of(state, c) + body.own_spin.momentum;
    }
    for (Place& place : places_) {
        Joint& joint = view.joints[place.joint];
        JointImpulses& impulses = impulses_of(joint, phase);
        if (phase == SolvePhase::velocity) {
            clear_impulses(impulses);
            continue;
        }

        // The unknown is the half of a row's impulse that comes before the drift.
        const double fraction = impulse_time_ > 0 ? substep / impulse_time_ : 0;
        for (double& impulse : impulses.rows) impulse *= fraction;
        const auto pose_of = [&](std::uint32_t body) -> Transform {
            return {view.bodies[body].center, view.bodies[body].rotation};
        };
        place.before = pose_joint(joint, joint.a_is_world ? Transform{} : pose_of(joint.a), pose_of(joint.b));
        if (is_linear_) {
            add_turning(place, joint);
            clear_impulses(impulses);
        }
    }
}

// A force that pulls at an arm turns the arm back: over the substep by −h (F·r) ω across r. Without this, oscillations
// of light links under a large tension would grow.
void JointSystem::add_turning(const Place& place, const Joint& joint) {
    Vec3 force;
    for (std::size_t row = 0; row < static_cast<std::size_t>(joint.row_count); ++row) {
        force += joint.rows[row].linear * joint.position_phase.rows[row];
    }
    const auto add = [&](std::int32_t body, Vec3 pull, Vec3 arm) {
        const double along = dot(pull, arm), square = length_squared(arm);
        if (body < 0 || !(along > 0) || !(square > 0)) return;
        bodies_[static_cast<std::size_t>(body)].turning +=
            (Mat3::identity() - outer(arm, arm) * (1 / square)) * (substep_ * along);
    };
    add(place.a, -force, place.before.geometry.arm_a);
    add(place.b, force, place.before.geometry.arm_b);
}

// Changes of the velocities since the last iteration were not made by the joints.
void JointSystem::absorb_changes(const View& view) {
    for (Body& body : bodies_) {
        const BodyState& state = view.bodies[body.slot];
        const Vec3 spin = state.angular_velocity - body.last_spin;
        body.free_velocity += state.linear_velocity - body.last_velocity;
        body.free_spin += spin;
        body.free_momentum += body.inertia * spin;
    }
}

// Finds what holds the free coordinates; returns the largest error of speed there.
double JointSystem::choose_holds(const View& view) {
    const JointPhase phase{phase_, substep_, view.settings};
    double largest = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        Joint& joint = view.joints[place.joint];
        Vec6& right_side = unknowns_[bodies_.size() + i];
        right_side = {};
        const double excess = choose_free_hold(joint, phase, is_first_, view.bodies);
        const bool is_held = impulses_of(joint, phase_).hold != FreeHold::nothing;
        if (is_held != place.is_held) has_factors_ = false;
        place.is_held = is_held;
        if (is_held) right_side.value[max_joint_rows - 1] = excess;
        largest = std::max(largest, std::fabs(excess));
    }
    return largest;
}

// By how much each row's speed is too large, as right sides; returns the largest. In the position phase these are for
// the poses after the drift (without the bodies' own spin, which the joints do not see), with the rows of the mean of
// both poses.
double JointSystem::find_excess(const View& view) {
    double largest = 0;
    const bool has_drift = phase_ == SolvePhase::position;
    const double max_correction = JointPhase{phase_, substep_, view.settings}.max_correction();
    for (Body& body : bodies_) {
        const BodyState& state = view.bodies[body.slot];
        if (!has_drift) break;
        body.after = {state.center + state.linear_velocity * substep_,
                      normalized(cayley(state.angular_velocity * substep_) * state.rotation)};
    }
    const auto pose_after = [&](std::int32_t body, std::uint32_t slot) -> Transform {
        if (body >= 0) return bodies_[static_cast<std::size_t>(body)].after;
        const BodyState& state = view.bodies[slot];
        return {state.center + state.linear_velocity * substep_,
                normalized(cayley(state.angular_velocity * substep_) * state.rotation)};
    };
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place& place = places_[i];
        Joint& joint = view.joints[place.joint];
        double* right_side = unknowns_[bodies_.size() + i].value;
        if (is_linear_) place.after = place.before;
        if (has_drift && !is_linear_) {
            place.after = pose_joint(joint, joint.a_is_world ? Transform{} : pose_after(place.a, joint.a),
                                     pose_after(place.b, joint.b));
        }
        if (has_drift) set_rows(joint, mean_of(place.before.geometry, place.after.geometry));
        for (std::size_t row = 0; row < static_cast<std::size_t>(joint.row_count); ++row) {
            right_side[row] = has_drift && !is_linear_ ? 0 : row_speed(joint, joint.rows[row], view.bodies);
            if (has_drift) {
                const double error = place.before.errors[row];
                const double rest = errors_ == Errors::kept ? error : rest_of_error(error, max_correction);
                right_side[row] += (place.after.errors[row] - rest) / substep_;
            }
            largest = std::max(largest, std::fabs(right_side[row]));
        }
    }
    return largest;
}

// The impulses of all joints on the bodies, by the present rows.
void JointSystem::sum_impulses(const View& view, bool with_free_rows) {
    for (Body& body : bodies_) body.impulse = {};
    for (const Place& place : places_) {
        const Joint& joint = view.joints[place.joint];
        const JointImpulses& impulses = phase_ == SolvePhase::position ? joint.position_phase : joint.velocity_phase;
        Vec3 linear, angular_a, angular_b;
        const auto add = [&](const JointRow& row, double impulse) {
            linear += row.linear * impulse;
            angular_a += row.angular_a * impulse;
            angular_b += row.angular_b * impulse;
        };
        for (std::size_t row = 0; row < static_cast<std::size_t>(joint.row_count); ++row) {
            add(joint.rows[row], impulses.rows[row]);
        }
        if (with_free_rows) add(joint.free_row, impulses.motor + impulses.lower - impulses.upper);
        const auto add_to_body = [&](std::int32_t body, Vec3 force, Vec3 torque) {
            if (body < 0) return;
            Vec6& sum = bodies_[static_cast<std::size_t>(body)].impulse;
            sum = make_vec6(sum.linear() + force, sum.angular() + torque);
        };
        add_to_body(place.a, -linear, -angular_a);
        add_to_body(place.b, linear, angular_b);
    }
}

// R of the equations of motion, as right sides; returns the largest as a speed. In the velocity phase the equations are
// linear, and each iteration keeps them.
double JointSystem::find_residuals(const View& view) {
    double largest = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        unknowns_[i] = {};
        if (phase_ == SolvePhase::velocity) continue;
        const BodyState& state = view.bodies[body.slot];
        const Vec3 linear =
            body.impulse.linear() - (state.linear_velocity - body.free_velocity) * view.constants[body.slot].mass;

        // I ω + h/2 ω × I ω − L₀, turned to where the joints' moment T is by (1 − h/2 ω×)⁻¹.
        const Vec3 spin = state.angular_velocity;
        Vec3 inertial = body.inertia * (spin - body.free_spin);
        if (is_linear_) {
            inertial += body.turning * spin;
        } else if (body.has_gyroscopic_torque) {
            const Vec3 half_turn = spin * (substep_ / 2), momentum = body.inertia * spin + body.own_spin.momentum;
            inertial = inverse_of_turning(half_turn) * (momentum + cross(half_turn, momentum) - body.free_momentum);
        }
        const Vec3 angular = body.impulse.angular() - inertial;
        unknowns_[i] = make_vec6(linear, angular);
        largest = std::max({largest, length(linear) * state.inverse_mass, length(state.inverse_inertia * angular)});
    }
    return largest;
}

void JointSystem::add_body_blocks(const View& view) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body& body = bodies_[i];
        Mat3 angular = body.inertia + body.turning;
        if (body.has_gyroscopic_torque && !is_linear_) {
            // Derivative of y of find_residuals(): dy = (1 − a×)⁻¹ ((1 + a×) I − h/2 (I ω + y)×) dω.
            const Vec3 spin = view.bodies[body.slot].angular_velocity;
            const Vec3 half_turn = spin * (substep_ / 2), momentum = body.inertia * spin + body.own_spin.momentum;
            const Mat3 inverse = inverse_of_turning(half_turn);
            const Vec3 y = inverse * (momentum + cross(half_turn, momentum) - body.free_momentum);
            angular = inverse * (body.inertia + skew(half_turn) * body.inertia - skew(momentum + y) * (substep_ / 2));
        }
        add_to(matrix_.diagonal(i), Mat3::identity() * view.constants[body.slot].mass, Mat3::zero(), Mat3::zero(),
               angular);
    }
}

// A force turns its arm back to it: −dT/dω = −h/2 f× (1 − h/2 ω×)⁻¹ r×. Without it light links under a large tension
// would have to be followed through each of their oscillations. A pressing force, which turns it away, is left to the
// iterations: there the block could become singular.
void JointSystem::add_turning_forces(const Place& place, const View& view) {
    const Joint& joint = view.joints[place.joint];
    const JointImpulses& impulses = joint.position_phase;
    Vec3 force = joint.free_row.linear * (impulses.motor + impulses.lower - impulses.upper);
    for (std::size_t row = 0; row < static_cast<std::size_t>(joint.row_count); ++row) {
        force += joint.rows[row].linear * impulses.rows[row];
    }
    const auto add = [&](std::int32_t body, Vec3 pull, Vec3 arm) {
        if (body < 0 || !(dot(pull, arm) > 0)) return;
        const auto number = static_cast<std::size_t>(body);
        const Vec3 half_turn = view.bodies[bodies_[number].slot].angular_velocity * (substep_ / 2);
        const Mat3 stiffness = skew(pull) * inverse_of_turning(half_turn) * skew(arm) * (-substep_ / 2);
        add_to(matrix_.diagonal(number), Mat3::zero(), Mat3::zero(), Mat3::zero(), stiffness);
    };
    const JointGeometry mean = mean_of(place.before.geometry, place.after.geometry);
    add(place.a, -force, mean.arm_a);
    add(place.b, force, mean.arm_b);
}

void JointSystem::add_joint_blocks(std::size_t number, const View& view) {
    const Place& place = places_[number];
    const Joint& joint = view.joints[place.joint];
    Block6& own = matrix_.diagonal(bodies_.size() + number);
    for (int row = 0; row < max_joint_rows; ++row) own.column[row][row] = -1;

    // The impulses are by mean rows, the speeds by the rows of the pose after the drift.
    const bool has_drift = phase_ == SolvePhase::position;
    const JointRows after =
        has_drift ? make_rows(joint, place.after.geometry) : JointRows{joint.row_count, joint.rows, joint.free_row};
    const auto put_row = [&](int row, const JointRow& mean, const JointRow& end) {
        own.column[row][row] = -view.settings.regularisation * row_response(joint, mean, view.bodies);
        const auto put = [&](std::int32_t body, std::uint32_t edge, Vec3 linear, Vec3 mean_angular, Vec3 end_linear,
                             Vec3 end_angular) {
            if (body < 0) return;
            if (has_drift && !is_linear_) {
                const Vec3 spin = view.bodies[bodies_[static_cast<std::size_t>(body)].slot].angular_velocity;
                end_angular = row_of_turning(end_angular, spin * (substep_ / 2));
            }
            const Vec6 to_body = make_vec6(linear, mean_angular), to_row = make_vec6(end_linear, end_angular);
            const bool joint_has_rows = matrix_.row_end(edge) == 0;
            Block6 &lower = matrix_.lower(edge), &upper = matrix_.upper(edge);
            for (int i = 0; i < 6; ++i) {
                (joint_has_rows ? lower.column[i][row] : upper.column[row][i]) = to_row.value[i];
                (joint_has_rows ? upper.column[i][row] : lower.column[row][i]) = to_body.value[i];
            }
        };
        put(place.a, place.edge_a, mean.linear, mean.angular_a, end.linear, end.angular_a);
        const JointRow minus_mean = opposite(mean), minus_end = opposite(end);
        put(place.b, place.edge_b, minus_mean.linear, minus_mean.angular_b, minus_end.linear, minus_end.angular_b);
    };
    for (int row = 0; row < joint.row_count; ++row) {
        put_row(row, joint.rows[static_cast<std::size_t>(row)], after.rows[static_cast<std::size_t>(row)]);
    }
    if (place.is_held) put_row(max_joint_rows - 1, joint.free_row, after.free_row);
}

void JointSystem::factor(const View& view) {
    has_factors_ = true;
    matrix_.clear();
    add_body_blocks(view);
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (phase_ == SolvePhase::position && !is_linear_) add_turning_forces(places_[i], view);
        add_joint_blocks(i, view);
    }
    matrix_.factor();
}

void JointSystem::apply_solution(const View& view) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        Body& body = bodies_[i];
        BodyState& state = view.bodies[body.slot];
        state.linear_velocity += unknowns_[i].linear();
        state.angular_velocity += unknowns_[i].angular();
        body.last_velocity = state.linear_velocity;
        body.last_spin = state.angular_velocity;
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Joint& joint = view.joints[places_[i].joint];
        const double* change = unknowns_[bodies_.size() + i].value;
        JointImpulses& impulses = impulses_of(joint, phase_);
        for (std::size_t row = 0; row < static_cast<std::size_t>(joint.row_count); ++row) {
            impulses.rows[row] += change[row];
        }
        if (places_[i].is_held) add_free_impulse(joint, phase_, change[max_joint_rows - 1]);
    }
}

double JointSystem::round(const View& view) {
    absorb_changes(view);
    double error = choose_holds(view);
    error = std::max(error, find_excess(view));
    if (phase_ == SolvePhase::position) sum_impulses(view, true);
    error = std::max(error, find_residuals(view));
    const bool is_slow = !is_first_ && error > view.settings.refactor_ratio * last_error_;
    if (is_slow && phase_ == SolvePhase::position) has_factors_ = false;
    is_first_ = false;
    last_error_ = error;
    if (error <= view.settings.speed_tolerance) return error;
    if (!has_factors_) factor(view);
    matrix_.solve(unknowns_);
    apply_solution(view);
    return error;
}

// Newton's method; returns whether it converged.
bool JointSystem::iterate(const View& view) {
    const JointSettings& settings = view.settings;
    double last = 0, error = 0;
    for (int count = 0; count < settings.max_iterations; ++count) {
        error = round(view);
        const bool stagnates = count > 1 && error > settings.stagnation_ratio * last;
        if (error <= settings.speed_tolerance || (error <= settings.rounding_tolerance && stagnates)) return true;
        const bool rises = count >= settings.nonmonotone_iterations && error > settings.max_error_ratio * last;
        if (!(error < settings.divergence_speed) || rises) return false;
        last = error;
    }
    return error <= settings.rounding_tolerance;
}

void JointSystem::advance(double time, const View& view, Errors errors) {
    errors_ = errors;
    prepare_all(view);
    advance(time, view.settings.max_halvings, view);
    errors_ = Errors::corrected;
}

void JointSystem::list_carriers(const View& view, std::vector<std::pair<std::uint32_t, BodyState>>& carriers) const {
    carriers.clear();
    for (const std::uint32_t slot : carriers_) carriers.emplace_back(slot, view.bodies[slot]);
}

void JointSystem::advance(double time, int halvings, const View& view) {
    Start& start = starts_[static_cast<std::size_t>(halvings)];
    remember(start, view);
    if (advance_in_one(time, Motion::any, view)) return;
    go_back(start, view);
    if (halvings == 0) {
        advance_in_one(time, Motion::small, view);
        return;
    }
    for (int half = 0; half < 2; ++half) advance(time / 2, halvings - 1, view);
}

// False where the method did not converge.
bool JointSystem::advance_in_one(double time, Motion motion, const View& view) {
    for (const Body& body : bodies_) kick(view.bodies[body.slot], view.constants[body.slot], time / 2);
    const double energy = kinetic_energy(view);
    for (Body& body : bodies_) {
        if (motion == Motion::any) {
            take_spin_aside(body, time, view);
        } else {
            split_gyroscopic(view.bodies[body.slot], view.constants[body.slot], time);
        }
    }

    // Motion.
    begin_phase(SolvePhase::position, time, motion, view);
    if (!iterate(view)) {
        if (motion == Motion::any) {
            for (Body& body : bodies_) body.own_spin = {};
            return false;
        }
        bound_energy(energy, view);  // before the drift by what the last iteration left
    }
    end_position_phase(view);
    add_impulses_to_totals(view);
    drift_all(view);
    prepare_all(view);
    bound_energy(energy, view);

    // Velocities. Their projection onto those that the joints allow adds no energy, whether or not it converges.
    for (const Body& body : bodies_) kick(view.bodies[body.slot], view.constants[body.slot], time / 2);
    const double kicked_energy = kinetic_energy(view);
    begin_phase(SolvePhase::velocity, time, motion, view);
    iterate(view);
    bound_energy(kicked_energy, view);
    add_impulses_to_totals(view);
    return true;
}

void JointSystem::remember(Start& start, const View& view) const {
    start.bodies.clear();
    start.carriers.clear();
    start.joints.clear();
    for (const Body& body : bodies_) start.bodies.push_back(view.bodies[body.slot]);
    for (const std::uint32_t slot : carriers_) start.carriers.push_back(view.bodies[slot]);
    for (const Place& place : places_) start.joints.push_back(view.joints[place.joint]);
    start.impulse_time = impulse_time_;
}

void JointSystem::go_back(const Start& start, const View& view) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) view.bodies[bodies_[i].slot] = start.bodies[i];
    for (std::size_t i = 0; i < carriers_.size(); ++i) view.bodies[carriers_[i]] = start.carriers[i];
    for (std::size_t i = 0; i < places_.size(); ++i) view.joints[places_[i].joint] = start.joints[i];
    impulse_time_ = start.impulse_time;
}

// With the other half of the joints' impulses.
void JointSystem::drift_all(const View& view) {
    for (Body& body : bodies_) {
        BodyState& state = view.bodies[body.slot];
        if (body.own_spin.rate != 0) {
            drift_spinning(body, view);
        } else {
            drift(state, view.constants[body.slot], substep_);
        }
        state.linear_velocity += body.second_half.linear();
        state.angular_velocity += body.second_half.angular();
    }
    for (const std::uint32_t slot : carriers_) drift_kinematic(view.bodies[slot], substep_);
}

void JointSystem::prepare_all(const View& view) const {
    for (const Place& place : places_) prepare_joint(view.joints[place.joint], view.bodies);
}

double JointSystem::kinetic_energy(const View& view) const {
    double sum = 0;
    for (const Body& body : bodies_) {
        const BodyState& state = view.bodies[body.slot];
        const BodyConstants& c = view.constants[body.slot];
        const Vec3 spin = rotate_inverse(state.rotation, state.angular_velocity);
        sum += c.mass * length_squared(state.linear_velocity) + dot(spin, c.inertia * spin);
    }
    return sum / 2;
}

// Joints do no work, except where errors are corrected or the solve did not converge; contacts take energy, except
// where sweeps do not converge: then they must not add any.
double JointSystem::bound_energy(double most, const View& view) const {
    const auto moves = [&](std::uint32_t slot) {
        return view.bodies[slot].linear_velocity != Vec3{} || view.bodies[slot].angular_velocity != Vec3{};
    };
    if (has_motor_ || std::any_of(carriers_.begin(), carriers_.end(), moves)) return 1;
    const double energy = kinetic_energy(view);
    if (!(energy > most * (1 + view.settings.energy_tolerance))) return 1;
    const double fraction = std::sqrt(most / energy);
    for (const Body& body : bodies_) {
        view.bodies[body.slot].linear_velocity *= fraction;
        view.bodies[body.slot].angular_velocity *= fraction;
    }
    return fraction;
}

double JointSystem::mass(const View& view) const {
    double sum = 0;
    for (const Body& body : bodies_) sum += view.constants[body.slot].mass;
    return sum;
}

void JointSystem::add_impulses_to_totals(const View& view) const {
    for (const Place& place : places_) add_to_totals(view.joints[place.joint], phase_);
}

void JointSystem::end_position_phase(const View& view) {
    impulse_time_ = is_linear_ ? substep_ : 2 * substep_;
    for (Body& body : bodies_) body.second_half = {};
    if (is_linear_) return;

    // The moments before the drift, those of free rows included, then the second halves.
    sum_impulses(view, true);
    for (Body& body : bodies_) body.free_momentum += body.impulse.angular();
    sum_impulses(view, false);
    for (Body& body : bodies_) {
        BodyState& state = view.bodies[body.slot];
        const Vec3 linear = body.impulse.linear() * state.inverse_mass, angular = body.impulse.angular();
        body.second_half = make_vec6(linear, state.inverse_inertia * angular);
        if (!body.has_gyroscopic_torque) continue;

        // The drift turns the momentum into the angular velocity after it.
        body.second_half = make_vec6(linear, {});
        state.hidden_momentum = body.free_momentum + angular - body.inertia * state.angular_velocity;
    }
    for (const Place& place : places_) {
        for (double& impulse : view.joints[place.joint].position_phase.rows) impulse *= 2;
    }
}

}  // namespace embody::physics::constraint
