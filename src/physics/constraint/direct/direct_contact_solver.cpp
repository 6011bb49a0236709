// SPDX-License-Identifier: MIT
//
// A step of few bodies in contact: forces, all velocities at once, drift, all positions at once.
#include "physics/constraint/direct/direct_contact_solver.h"

#include <algorithm>
#include <cmath>

#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

namespace {

constexpr double cone_rounding = 1e-6;  // fraction by which friction may exceed its cone; floats exceed it by 1e-7

// How the point moved with the body in this step; on a round body only the tilt counts (contact.cpp).
Vec3 motion_at(Vec3 displacement, const Quat& turn, Vec3 arm, bool is_round) {
    if (!is_round) return displacement + rotate(turn, arm) - arm;
    const double sign = turn.w < 0 ? -2 : 2;
    return displacement + cross(sign * Vec3{turn.x, turn.y, turn.z}, arm);
}

}  // namespace

void DirectContactSolver::begin(double time_step, int substeps, const ConstraintSettings& settings) {
    settings_ = settings.direct;
    correction_speed_ = settings.contact.max_correction_speed;
    time_step_ = time_step;
    moving_substeps_ = substeps;
    newton_.begin_step(settings_);
}

DirectContactSolver::Outcome DirectContactSolver::solve(const List& list, Effort effort, std::span<BodyState> bodies,
                                                        std::span<const BodyConstants> constants,
                                                        std::span<Contact> contacts) {
    substeps_ = list.impulse_parts;
    substep_ = time_step_ / substeps_;
    number_bodies(list.bodies, bodies.size());
    if (stays_at_rest(list, bodies, constants, contacts)) return Outcome::held;
    const bool only_slow = effort == Effort::while_slow;
    const double slow = settings_.slow_speed;
    const auto is_fast = [&](std::uint32_t body) { return length_squared(bodies[body].linear_velocity) > slow * slow; };
    if (only_slow && std::any_of(list.bodies.begin(), list.bodies.end(), is_fast)) return Outcome::unsolved;

    const bool may_wait = newton_.has_given_up(list.bodies.front()) || newton_.work() > settings_.max_products_step;
    if (only_slow && may_wait) return Outcome::unsolved;

    // Slow bodies in one solve; should they turn out to move, from the beginning again.
    gather(list, bodies, constants, contacts, 1);
    if (only_slow && newton_.block_products() > settings_.max_products_slow) return Outcome::unsolved;
    if (is_slow(slow)) {
        if (rest(only_slow, contacts) && is_slow(slow)) {
            newton_.note_rest();
            scatter(bodies, constants, contacts, 1);
            return Outcome::solved;
        }
        if (only_slow) newton_.abandon();
    }
    if (only_slow) return Outcome::unsolved;
    gather(list, bodies, constants, contacts, moving_substeps_);
    if (!move(moving_substeps_, contacts)) return Outcome::unsolved;
    scatter(bodies, constants, contacts, moving_substeps_);
    return Outcome::solved;
}

void DirectContactSolver::number_bodies(std::span<const std::uint32_t> slots, std::size_t all) {
    if (number_of_slot_.size() < all) number_of_slot_.resize(all);
    motion_.resize(slots.size());
    for (std::size_t i = 0; i < slots.size(); ++i) {
        motion_[i].slot = slots[i];
        number_of_slot_[slots[i]] = static_cast<std::int32_t>(i);
    }
    for (std::vector<Vec6>* memory : {&velocity_, &free_velocity_, &shift_}) memory->resize(slots.size());
    masses_.resize(slots.size());
}

std::int32_t DirectContactSolver::number_of(std::uint32_t slot) const {
    const auto number = static_cast<std::size_t>(number_of_slot_[slot]);
    const bool is_ours = number < motion_.size() && motion_[number].slot == slot;
    return is_ours ? number_of_slot_[slot] : DirectPatch::immovable;
}

// Whether the last impulses hold everything where it is: then they are the solution. The rounding error of the stored
// impulses is no reason to move.
bool DirectContactSolver::stays_at_rest(const List& list, std::span<BodyState> bodies,
                                        std::span<const BodyConstants> constants, std::span<Contact> contacts) {
    std::vector<Vec6>& momentum = shift_;
    const double most = settings_.held_speed_tolerance * settings_.held_speed_tolerance;
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        const BodyState& state = bodies[motion_[i].slot];
        const BodyConstants& c = constants[motion_[i].slot];
        if (length_squared(state.linear_velocity) + length_squared(state.angular_velocity) > most) return false;
        if (state.center != state.start_center) return false;
        momentum[i] = make_vec6(c.acceleration * (c.mass * substep_), c.torque * substep_);
    }
    for (const std::uint32_t index : list.contacts) {
        if (!holds_at_rest(contacts[index])) return false;
    }
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        const BodyState& state = bodies[motion_[i].slot];
        const Vec3 linear = momentum[i].linear() * state.inverse_mass;
        const Vec3 angular = state.inverse_inertia * momentum[i].angular();
        if (!(length_squared(linear) + length_squared(angular) <= most)) return false;
    }
    for (const Motion& motion : motion_) {
        bodies[motion.slot].linear_velocity = bodies[motion.slot].angular_velocity = {};
    }
    hold(list, contacts);
    return true;
}

void DirectContactSolver::hold(const List& list, std::span<Contact> contacts) {
    const auto times = static_cast<float>(list.impulse_parts);
    for (const std::uint32_t index : list.contacts) {
        Contact& contact = contacts[index];
        for (int i = 0; i < contact.count; ++i) {
            ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            point.total += point.impulse * times;
        }
        contact.friction_total.along_1 += contact.friction.along_1 * times;
        contact.friction_total.along_2 += contact.friction.along_2 * times;
        contact.friction_total.twist += contact.friction.twist * times;
    }
}

// Adds a contact's last impulses to the bodies' momentum; false where they cannot be the next impulses.
bool DirectContactSolver::holds_at_rest(const Contact& contact) {
    const double rest_gap = settings_.rest_gap_tolerance;
    const Anchor anchor = anchor_of(contact);
    const Vec3 friction = friction_force(contact, contact.friction);
    const Vec3 moment = contact.normal * static_cast<double>(contact.friction.twist) + contact.rolling;
    Vec3 force = friction;
    Vec3 torque_a = cross(anchor.arm_a, friction) + moment, torque_b = cross(anchor.arm_b, friction) + moment;
    double normal = 0;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double gap = point.separation;
        const bool is_loaded = point.impulse > 0;
        if (gap < -rest_gap || (is_loaded && gap > rest_gap) || point.inactive_until > 0) return false;
        const Vec3 impulse = contact.normal * static_cast<double>(point.impulse);
        force += impulse;
        torque_a += cross(point.arm_a, impulse);
        torque_b += cross(point.arm_b, impulse);
        normal += point.impulse;
    }
    const double bound = contact.friction_dynamic * normal;
    if (length_squared(friction) > bound * bound * (1 + cone_rounding)) return false;

    std::vector<Vec6>& momentum = shift_;
    const auto add = [&](std::int32_t body, Vec3 linear, Vec3 angular, double sign) {
        if (body < 0) return;
        double* to = momentum[static_cast<std::size_t>(body)].value;
        for (int i = 0; i < 3; ++i) {
            to[i] += sign * linear[i];
            to[i + 3] += sign * angular[i];
        }
    };
    add(number_of(contact.a), force, torque_a, -1);
    add(number_of(contact.b), force, torque_b, 1);
    return true;
}

void DirectContactSolver::gather(const List& list, std::span<const BodyState> bodies,
                                 std::span<const BodyConstants> constants, std::span<const Contact> contacts,
                                 int substeps) {
    h_ = substep_ * substeps_ / substeps;
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        Motion& motion = motion_[i];
        BodyState state = bodies[motion.slot];
        const BodyConstants& c = constants[motion.slot];
        state.hidden_momentum = {};
        const double step = substep_ * substeps_;
        if (has_gyroscopic_torque(state, c, step)) split_gyroscopic_of_turns(state, c, step, substeps);
        motion.hidden_momentum = state.hidden_momentum;
        motion.hidden_energy = state.hidden_energy;
        motion.kick = make_vec6(c.acceleration * h_, state.inverse_inertia * (c.torque * h_));
        motion.linear_damping = 1 / (1 + h_ * c.linear_damping);
        motion.angular_damping = 1 / (1 + h_ * c.angular_damping);
        motion.acceleration = c.acceleration;
        motion.displacement = state.center - state.start_center;
        motion.turn = state.turn;
        velocity_[i] = make_vec6(state.linear_velocity, state.angular_velocity);
        masses_[i] = {c.mass, c.is_isotropic ? c.inertia : rotate_tensor(state.rotation, c.inertia)};
    }
    patches_.clear();
    for (const std::uint32_t index : list.contacts) {
        patches_.push_back(make_patch(index, contacts[index], static_cast<double>(substeps_) / substeps));
        patches_.back().a = number_of(contacts[index].a);
        patches_.back().b = number_of(contacts[index].b);
    }
    newton_.begin(list.bodies.front(), masses_, patches_);
}

void DirectContactSolver::scatter(std::span<BodyState> bodies, std::span<const BodyConstants> constants,
                                  std::span<Contact> contacts, int substeps) const {
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        const Motion& motion = motion_[i];
        BodyState& state = bodies[motion.slot];
        const BodyConstants& c = constants[motion.slot];
        state.center = state.start_center + motion.displacement;
        state.linear_velocity = velocity_[i].linear();
        state.angular_velocity = velocity_[i].angular();
        state.hidden_momentum = motion.hidden_momentum;
        state.hidden_energy = motion.hidden_energy;
        if (motion.turn != state.turn) finish_turn(state, c, motion.turn);
    }
    for (const DirectPatch& patch : patches_) {
        write_patch(patch, static_cast<double>(substeps) / substeps_, contacts[patch.contact]);
    }
}

bool DirectContactSolver::is_slow(double most) const {
    const auto is_slow_at = [&](std::int32_t body, Vec3 arm) {
        if (body < 0) return true;
        const Vec6& v = velocity_[static_cast<std::size_t>(body)];
        return length(v.linear()) + length(v.angular()) * length(arm) < most;
    };
    return std::all_of(patches_.begin(), patches_.end(), [&](const DirectPatch& patch) {
        const bool is_whole = std::all_of(patch.points.begin(), patch.points.end(),
                                          [](const DirectPatch::Point& point) { return point.inactive_until <= 0; });
        return is_whole && is_slow_at(patch.a, patch.arm_a) && is_slow_at(patch.b, patch.arm_b);
    });
}

// One solve for the whole step. Islands that are solved directly in motion, too, mostly go on as before, which takes
// one iteration.
bool DirectContactSolver::rest(bool only_slow, std::span<const Contact> contacts) {
    measure_gaps(contacts);
    for (DirectPatch& patch : patches_) begin_substep(patch, {h_, h_, settings_.rest_gap_tolerance}, settings_);
    kick();
    const bool goes_on = !only_slow && newton_.find_velocities(free_velocity_, velocity_, patches_);
    if (!goes_on && !newton_.find_rest(free_velocity_, velocity_, patches_)) return false;
    drift();
    measure_gaps(contacts);
    if (worst_gap() > settings_.rest_gap_tolerance) {
        // With sticking, overlaps would stay, or other contacts would open while these close.
        newton_.drop_friction(patches_);
        correct_positions(settings_.rest_correction_fraction, settings_.max_rest_shift, contacts);
    }
    for (DirectPatch& patch : patches_) end_substep(patch);
    return true;
}

bool DirectContactSolver::move(int substeps, std::span<const Contact> contacts) {
    measure_gaps(contacts);
    for (int substep = 1; substep <= substeps; ++substep) {
        // Forces and what answers them.
        for (DirectPatch& patch : patches_) begin_substep(patch, {substep * h_, h_}, settings_);
        kick();
        if (!newton_.find_velocities(free_velocity_, velocity_, patches_)) return false;

        // Motion.
        drift();
        measure_gaps(contacts);
        if (worst_gap() > settings_.moving_gap_tolerance)
            correct_positions(settings_.moving_correction_fraction, correction_speed_ * h_, contacts);
        for (DirectPatch& patch : patches_) end_substep(patch);
    }
    return true;
}

void DirectContactSolver::kick() {
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        const Motion& motion = motion_[i];
        for (int k = 0; k < 6; ++k) {
            const double damping = k < 3 ? motion.linear_damping : motion.angular_damping;
            free_velocity_[i].value[k] = (velocity_[i].value[k] + motion.kick.value[k]) * damping;
        }
    }
}

void DirectContactSolver::drift() {
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        Motion& motion = motion_[i];
        const Vec3 v = velocity_[i].linear(), w = velocity_[i].angular();
        motion.displacement += v * h_;
        motion.turn = normalized(cayley(w * h_) * motion.turn);

        // A body that touched nothing: its mean velocity is half a kick behind.
        if (v == free_velocity_[i].linear()) motion.displacement -= motion.acceleration * (h_ * h_ / 2);
    }
}

void DirectContactSolver::measure_gaps(std::span<const Contact> contacts) {
    for (DirectPatch& patch : patches_) {
        const Contact& contact = contacts[patch.contact];
        const auto move = [&](std::int32_t body, Vec3 arm, bool is_round) {
            if (body < 0) return Vec3{};
            const Motion& motion = motion_[static_cast<std::size_t>(body)];
            return motion_at(motion.displacement, motion.turn, arm, is_round);
        };
        for (int i = 0; i < patch.count; ++i) {
            const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            const Vec3 apart =
                move(patch.b, point.arm_b, contact.b_is_round) - move(patch.a, point.arm_a, contact.a_is_round);
            patch.points[static_cast<std::size_t>(i)].gap = point.separation + dot(patch.normal, apart);
        }
    }
}

double DirectContactSolver::worst_gap() const {
    double worst = 0;
    for (const DirectPatch& patch : patches_) {
        for (const DirectPatch::Point& point : patch.points) {
            if (point.is_loaded) worst = std::max(worst, std::fabs(point.gap));
        }
    }
    return worst;
}

void DirectContactSolver::correct_positions(double fraction, double most, std::span<const Contact> contacts) {
    newton_.find_shifts(patches_, fraction, correction_speed_ * h_, shift_);
    double longest = 0;
    for (const Vec6& shift : shift_) longest = std::max(longest, length(shift.linear()));
    const double scale = longest > most ? most / longest : 1;
    for (std::size_t i = 0; i < motion_.size(); ++i) {
        motion_[i].displacement += shift_[i].linear() * scale;
        motion_[i].turn = normalized(cayley(shift_[i].angular() * scale) * motion_[i].turn);
    }
    measure_gaps(contacts);
}

}  // namespace embody::physics::constraint
