// SPDX-License-Identifier: MIT
//
// docs/physics/energy.md. Over a stage each body has the mean velocities
//     v̄ = (v₀ + v₁)/2,   ω̄ = I⁻¹ (L₀ + L₁)/2   with the inertia I of the rotation halfway,
// and an impulse P with the moment τ about the centre of mass does the work P·v̄ + τ·ω̄. For the sum of all that acts on
// a body this is the change of its kinetic energy: m (v₁ − v₀)·v̄ exactly, (L₁ − L₀)·ω̄ apart from the turning of the
// inertia, which is of the second order in the angle of the step.
#include "physics/state/ledger.h"

#include <algorithm>

#include "physics/dynamic/conserved.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/state/world_state.h"

namespace embody::physics::state {

namespace {

bool is_counted(const WorldState& world, std::uint32_t body) {
    return world.rigid.is_used(body) && world.rigid.is_dynamic(body) && world.rigid.record(body).definition.enabled;
}

Vec3 gravity_on(const WorldState& world, std::uint32_t body) {
    return world.settings.gravity * world.rigid.record(body).definition.gravity_factor;
}

Conserved sum_of_bodies(const WorldState& world) {
    Conserved sum;
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!is_counted(world, body)) continue;
        add_conserved(sum, world.rigid.motion[body], world.rigid.constants[body], gravity_on(world, body));
    }
    return sum;
}

Vec3 spin_momentum(Quat rotation, Vec3 spin, const BodyConstants& constants) {
    return rotate(rotation, constants.inertia * rotate_inverse(rotation, spin));
}

Quat halfway(const Quat& p, const Quat& q) {
    const double sign = dot(p, q) < 0 ? -1 : 1;
    return normalized(Quat{p.x + sign * q.x, p.y + sign * q.y, p.z + sign * q.z, p.w + sign * q.w});
}

// Forces that act on a body evenly over its mass, N and N m.
struct SteadyForces {
    Vec3 user, user_torque, air, coupling, coupling_torque;
};
SteadyForces forces_on(const WorldState& world, std::uint32_t body) {
    const BodyRecord& record = world.rigid.record(body);
    return {record.definition.force + record.next_force, record.definition.torque + record.next_torque,
            record.definition.drag_area > 0 ? record.drag : Vec3{}, record.deformable_force + record.fluid_force,
            record.deformable_torque + record.fluid_torque};
}

}  // namespace

void Ledger::add(StepCause cause, double work, Vec3 linear, Vec3 angular) {
    StepAccount::Entry& entry = account_.of(cause);
    entry.work += work;
    entry.linear_impulse += linear;
    entry.angular_impulse += angular;
}

// A stage with one cause: its effect is the difference of the sums before and after it.
void Ledger::measure(StepCause cause) {
    const Conserved now = sum_of_bodies(world_);
    add(cause, now.energy() - last_.energy(), now.linear_momentum - last_.linear_momentum,
        now.angular_momentum - last_.angular_momentum);
    last_ = now;
}

void Ledger::remember(std::uint32_t body) {
    const BodyState& state = world_.rigid.motion[body];
    Motion& motion = motions_[body];
    motion.center = state.center;
    motion.velocity = motion.mean_velocity = state.linear_velocity;
    motion.spin = motion.mean_spin = state.angular_velocity;
    motion.rotation = state.rotation;
    motion.moment = motion.scaled_impulse = motion.scaled_moment = {};
    motion.kept_fraction = 1;
    motion.rolls = false;
}

void Ledger::remember_totals(std::uint32_t contact) {
    const Contact& from = world_.contacts.list[contact];
    ContactTotals& to = contact_totals_[contact];
    for (std::size_t i = 0; i < from.count; ++i) to.normal[i] = from.points[i].total;
    to.friction = {from.friction_total.along_1, from.friction_total.along_2, from.friction_total.twist};
}

// Records all bodies: the zero velocities of those at rest are needed for the contacts with them.
void Ledger::begin_impacts() {
    motions_.resize(world_.rigid.bodies.slot_count());
    for (std::uint32_t body = 0; body < world_.rigid.bodies.slot_count(); ++body) {
        if (world_.rigid.is_used(body)) remember(body);
    }
}

void Ledger::begin() {
    account_ = {};
    account_.before = last_ = sum_of_bodies(world_);
}

void Ledger::close_wake() {
    if (world_.report.limits != 0) measure(StepCause::limits);
}

void Ledger::note_impact(std::span<const ImpactSite> sites, double energy_change) {
    add(StepCause::impacts, energy_change, {}, {});
    for (const ImpactSite& site : sites) {
        const BodyState &a = world_.rigid.motion[site.a], &b = world_.rigid.motion[site.b];
        if (site.impulse == Vec3{} || (a.inverse_mass > 0 && b.inverse_mass > 0)) continue;
        const bool is_on_b = b.inverse_mass > 0;
        const Vec3 impulse = is_on_b ? site.impulse : -site.impulse;
        const Vec3 place = is_on_b ? b.center + site.arm_b : a.center + site.arm_a;
        const Vec3 ground = is_on_b ? velocity_at(a, site.arm_a) : velocity_at(b, site.arm_b);
        add(StepCause::impacts, 0, impulse, cross(place, impulse));
        add(StepCause::moving_bodies, dot(impulse, ground), {}, {});
    }
}

// Bodies that collide start the step elsewhere, on the path that leads through the impact. On a body in flight the
// forces did work along both paths; a body that was carried was moved without forces and only changed its place.
void Ledger::add_displaced(std::uint32_t body) {
    const BodyState& state = world_.rigid.motion[body];
    const Vec3 displacement = state.center - motions_[body].center;
    const Vec3 weight = world_.rigid.constants[body].mass * gravity_on(world_, body);
    if (world_.impacts.is_supported[body]) {
        add(StepCause::position_correction, -dot(weight, displacement), {}, {});
        return;
    }
    const SteadyForces forces = forces_on(world_, body);
    add(StepCause::gravity, dot(weight, displacement), {}, {});
    add(StepCause::forces, dot(forces.user, displacement), {}, {});
    add(StepCause::air, dot(forces.air, displacement), {}, {});
    add(StepCause::coupling, dot(forces.coupling, displacement), {}, {});
}

// The impulse that a joint passed on in the impacts. Between bodies in free motion it does no work; but it is an
// impulse where the joint leads to the ground, and work where the ground moves: a kinematic carrier goes straight on.
void Ledger::note_blow(const Joint& joint) {
    joint_totals_.push_back({joint.total_linear, joint.total_angular});
    const bool ends_at_a = joint.a_is_world || world_.rigid.motion[joint.a].inverse_mass == 0;
    const BodyState& b = world_.rigid.motion[joint.b];
    if (!ends_at_a && b.inverse_mass > 0) return;
    const double sign = ends_at_a ? 1 : -1;
    const Vec3 place = b.center + rotate(b.rotation, joint.local_b.position);
    const Vec3 impulse = sign * joint.total_linear, moment = sign * joint.total_angular;
    add(has_motor(joint) ? StepCause::motors : StepCause::joints, 0, impulse, cross(place, impulse) + moment);
    if (ends_at_a && joint.a_is_world) return;
    const BodyState& carrier = ends_at_a ? world_.rigid.motion[joint.a] : b;
    const Vec3 velocity = velocity_at(carrier, place - carrier.center);
    add(StepCause::moving_bodies, dot(impulse, velocity) + dot(moment, carrier.angular_velocity), {}, {});
}

void Ledger::close_impacts() {
    contact_totals_.assign(world_.contacts.list.size(), {});
    for (std::uint32_t i = 0; i < world_.contacts.list.size(); ++i) {
        if (world_.contacts.list[i].had_impact) remember_totals(i);
    }
    joint_totals_.clear();
    for (const Joint& joint : world_.joints.active) note_blow(joint);
    if (world_.contacts.list.empty()) return;
    for (const std::uint32_t body : world_.activity.awake) {
        if (!is_counted(world_, body)) continue;
        if (world_.rigid.motion[body].center != motions_[body].center) add_displaced(body);
        remember(body);
    }
}

void Ledger::set_means(std::uint32_t body) {
    const BodyState& state = world_.rigid.motion[body];
    const BodyConstants& constants = world_.rigid.constants[body];
    Motion& motion = motions_[body];
    motion.mean_center = (motion.center + state.center) / 2;
    // A rolling body moves along a curve: its mean velocity is its displacement over time, not the mean of the ends.
    motion.mean_velocity =
        motion.rolls ? (state.center - motion.center) / time_ : (motion.velocity + state.linear_velocity) / 2;
    motion.mean_spin = (motion.spin + state.angular_velocity) / 2;
    if (constants.is_isotropic || state.inverse_mass == 0) return;
    const Quat rotation = halfway(motion.rotation, state.rotation);
    const Vec3 momentum = (spin_momentum(motion.rotation, motion.spin, constants) +
                           spin_momentum(state.rotation, state.angular_velocity, constants)) /
                          2;
    motion.mean_spin = rotate(rotation, constants.inverse_inertia * rotate_inverse(rotation, momentum));
}

void Ledger::add_forces(std::uint32_t body) {
    const Motion& motion = motions_[body];
    const auto add_force = [&](StepCause cause, Vec3 force, Vec3 torque) {
        if (force == Vec3{} && torque == Vec3{}) return;
        add(cause, (dot(force, motion.mean_velocity) + dot(torque, motion.mean_spin)) * time_, force * time_,
            (cross(motion.mean_center, force) + torque) * time_);
    };
    const SteadyForces forces = forces_on(world_, body);
    add_force(StepCause::gravity, world_.rigid.constants[body].mass * gravity_on(world_, body), {});
    add_force(StepCause::forces, forces.user, forces.user_torque);
    add_force(StepCause::air, forces.air, {});
    add_force(StepCause::coupling, forces.coupling, forces.coupling_torque);
}

// v ← v / (1 + c h/2) twice a substep h: over the step v ← f v, so of the mean (1 + f)/2 v it took (1 − f) v.
void Ledger::add_damping(std::uint32_t body) {
    const BodyConstants& constants = world_.rigid.constants[body];
    if (constants.linear_damping == 0 && constants.angular_damping == 0) return;
    const auto taken_of_mean = [&](double rate) {
        const double half = world_.settings.time_step / world_.settings.substeps / 2;
        double kept = 1;
        for (double left = time_; left > half / 2; left -= half) kept /= 1 + rate * half;
        return 2 * (1 - kept) / (1 + kept);
    };
    const Motion& motion = motions_[body];
    const Vec3 impulse = motion.mean_velocity * (-constants.mass * taken_of_mean(constants.linear_damping));
    const Quat rotation = halfway(motion.rotation, world_.rigid.motion[body].rotation);
    const Vec3 moment =
        spin_momentum(rotation, motion.mean_spin, constants) * -taken_of_mean(constants.angular_damping);
    add(StepCause::damping, dot(impulse, motion.mean_velocity) + dot(moment, motion.mean_spin), impulse,
        cross(motion.mean_center, impulse) + moment);
}

void Ledger::note_scaled(std::uint32_t body, double fraction) {
    // A body that was stopped whole has no velocity to measure; all that energy is booked to the joints.
    if (!(fraction > 0)) return;
    const BodyState& state = world_.rigid.motion[body];
    const BodyConstants& constants = world_.rigid.constants[body];
    const double change = 1 - 1 / fraction;
    motions_[body].scaled_impulse += constants.mass * change * state.linear_velocity;
    motions_[body].scaled_moment += change * spin_momentum(state.rotation, state.angular_velocity, constants);
}

void Ledger::add_scaling(std::uint32_t body) {
    const Motion& motion = motions_[body];
    const Vec3 impulse = motion.scaled_impulse, moment = motion.scaled_moment;
    if (impulse == Vec3{} && moment == Vec3{}) return;
    add(StepCause::limits, dot(impulse, motion.mean_velocity) + dot(moment, motion.mean_spin), impulse,
        cross(motion.mean_center, impulse) + moment);
}

// A displacement that no mean velocity accounts for: it lifts the body, and carries its momentum along.
void Ledger::add_correction(std::uint32_t body) {
    const Motion& motion = motions_[body];
    const double mass = world_.rigid.constants[body].mass;
    const Vec3 displacement = world_.rigid.motion[body].center - motion.center - motion.mean_velocity * time_;
    add(StepCause::position_correction, -mass * dot(gravity_on(world_, body), displacement), {},
        cross(displacement, mass * motion.mean_velocity));
}

void Ledger::add_push(const Push& push, StepCause cause) {
    const Motion &a = motions_[push.a], &b = motions_[push.b];
    const Vec3 speed_a = a.mean_velocity + cross(a.mean_spin, push.arm_a);
    const Vec3 speed_b = b.mean_velocity + cross(b.mean_spin, push.arm_b);
    const bool rolls = a.rolls || b.rolls;
    const auto work_at = [&](Vec3 speed, Vec3 spin) {
        return rolls ? 0 : dot(push.impulse, speed) + dot(push.moment, spin);
    };
    const double work_a = work_at(speed_a, a.mean_spin), work_b = work_at(speed_b, b.mean_spin);
    add(cause, work_b - work_a, {}, {});
    const auto moment_on = [&](const Motion& motion, Vec3 arm) {
        return cross(motion.mean_center + arm, push.impulse) + push.moment;
    };
    if (world_.rigid.motion[push.a].inverse_mass == 0) {
        add(cause, 0, push.impulse, moment_on(b, push.arm_b));
        add(StepCause::moving_bodies, work_a, {}, {});
    } else if (world_.rigid.motion[push.b].inverse_mass == 0) {
        add(cause, 0, -push.impulse, -moment_on(a, push.arm_a));
        add(StepCause::moving_bodies, -work_b, {}, {});
    }
}

// The impulses of the substeps, each at its own place. A contact stores the rolling resistance of the last substep
// only.
template <class Visit>
void Ledger::for_each_push(const Island& island, Visit visit) const {
    const int parts = island.joint_count > 0 ? 1
                                             : contact_plan(island.contact_count, world_.settings.substeps,
                                                            world_.settings.solver.constraint.contact)
                                                   .substeps;
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const std::uint32_t index = world_.islands.contacts[island.first_contact + k];
        const Contact& contact = world_.contacts.list[index];
        const ContactTotals& before = contact_totals_[index];
        const double fraction = std::min(motions_[contact.a].kept_fraction, motions_[contact.b].kept_fraction);
        const auto change = [fraction](float now, float then) {
            return fraction * (static_cast<double>(now) - static_cast<double>(then));
        };
        for (std::size_t i = 0; i < contact.count; ++i) {
            const ContactPoint& point = contact.points[i];
            const double impulse = change(point.total, before.normal[i]);
            if (impulse != 0)
                visit(Push{contact.a, contact.b, point.arm_a, point.arm_b, Vec3(contact.normal) * impulse, {}});
        }
        const PatchFriction& total = contact.friction_total;
        const Vec3 force = Vec3(contact.tangent_1) * change(total.along_1, before.friction[0]) +
                           tangent_2(contact) * change(total.along_2, before.friction[1]);
        const Vec3 moment =
            Vec3(contact.normal) * change(total.twist, before.friction[2]) + Vec3(contact.rolling) * (fraction * parts);
        if (force == Vec3{} && moment == Vec3{}) continue;
        const Anchor anchor = anchor_of(contact);
        visit(Push{contact.a, contact.b, anchor.arm_a, anchor.arm_b, force, moment});
    }
}

// Islands with contacts only are solved with each body's inertia at the start, in the mean velocity of its free
// rotation.
void Ledger::set_spins(const Island& island) {
    if (island.joint_count > 0) return;
    for_each_push(island, [&](const Push& push) {
        motions_[push.a].moment -= cross(push.arm_a, push.impulse) + push.moment;
        motions_[push.b].moment += cross(push.arm_b, push.impulse) + push.moment;
    });
    for (std::uint32_t k = 0; k < island.body_count; ++k) {
        const std::uint32_t body = world_.islands.bodies[island.first_body + k];
        const BodyConstants& constants = world_.rigid.constants[body];
        Motion& motion = motions_[body];
        if (motion.moment == Vec3{} || constants.is_isotropic || constants.angular_damping > 0) continue;
        BodyState start;
        start.rotation = motion.rotation;
        start.angular_velocity = motion.spin;
        if (has_gyroscopic_torque(start, constants, world_.settings.time_step)) {
            split_gyroscopic_of_turns(start, constants, world_.settings.time_step, world_.settings.substeps);
        }
        const Vec3 moment = motion.moment + constants.torque * time_;
        const Vec3 change =
            rotate(motion.rotation, constants.inverse_inertia * rotate_inverse(motion.rotation, moment));
        motion.mean_spin = start.angular_velocity + change / 2;
    }
}

// At a joint its bodies have one velocity before and after the step, but not in the mean of a turning arm: so the mean
// of both ends is taken.
void Ledger::add_joint(std::uint32_t index) {
    const Joint& joint = world_.joints.active[index];
    const Vec3 force = joint.total_linear - joint_totals_[index].linear;
    const Vec3 torque = joint.total_angular - joint_totals_[index].angular;
    joint_totals_[index] = {joint.total_linear, joint.total_angular};
    if (force == Vec3{} && torque == Vec3{}) return;
    const BodyState& b = world_.rigid.motion[joint.b];
    const Motion& start_b = motions_[joint.b];
    const Vec3 first = start_b.center + rotate(start_b.rotation, joint.local_b.position);
    const Vec3 last = b.center + rotate(b.rotation, joint.local_b.position);
    const auto work_on = [&](std::uint32_t body) {
        const BodyState& end = world_.rigid.motion[body];
        const Motion& start = motions_[body];
        const Vec3 speed =
            start.velocity + cross(start.spin, first - start.center) + velocity_at(end, last - end.center);
        return (dot(force, speed) + dot(torque, start.spin + end.angular_velocity)) / 2;
    };
    const StepCause cause = has_motor(joint) ? StepCause::motors : StepCause::joints;
    const double work_a = joint.a_is_world ? 0 : work_on(joint.a), work_b = work_on(joint.b);
    const Vec3 moment = cross((first + last) / 2, force) + torque;
    add(cause, work_b - work_a, {}, {});
    if (joint.a_is_world || world_.rigid.motion[joint.a].inverse_mass == 0) {
        add(cause, 0, force, moment);
        add(StepCause::moving_bodies, work_a, {}, {});
    } else if (b.inverse_mass == 0) {
        add(cause, 0, -force, -moment);
        add(StepCause::moving_bodies, -work_b, {}, {});
    }
}

void Ledger::close_island(const Island& island, double time) {
    time_ = time;
    const auto bodies = std::span(world_.islands.bodies).subspan(island.first_body, island.body_count);
    for (const std::uint32_t body : bodies) set_means(body);
    set_spins(island);
    for (const std::uint32_t body : bodies) {
        add_forces(body);
        add_damping(body);
        add_scaling(body);
        add_correction(body);
    }
    for_each_push(island, [&](const Push& push) { add_push(push, StepCause::contacts); });
    if (island.joint_count == 0) return;

    // Copies the totals for the next substep.
    for (const std::uint32_t joint : std::span(world_.islands.joints).subspan(island.first_joint, island.joint_count)) {
        add_joint(joint);
    }
    for (const std::uint32_t body : bodies) remember(body);
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        remember_totals(world_.islands.contacts[island.first_contact + k]);
    }
}

void Ledger::close_substeps() {
    for (const Island& island : world_.islands.list) {
        if (island.joint_count == 0) close_island(island, world_.settings.time_step);
    }

    // Adds the position changes since the last substep.
    time_ = 0;
    for (const Island& island : world_.islands.list) {
        if (island.joint_count == 0) continue;
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            add_correction(world_.islands.bodies[island.first_body + k]);
        }
    }
    last_ = sum_of_bodies(world_);
}

void Ledger::close_limits() {
    if (world_.report.limits != 0) measure(StepCause::limits);
}

void Ledger::close_continuous() { measure(StepCause::position_correction); }

void Ledger::close_deformables() {
    if (world_.deformables.records.count() > 0) measure(StepCause::coupling);
}

void Ledger::close_sleep() {
    if (!world_.events.sleep.empty()) measure(StepCause::sleep);
}

StepAccount Ledger::finish() {
    account_.after = last_;
    const Conserved &before = account_.before, &after = account_.after;
    account_.unexplained_energy = after.energy() - before.energy();
    account_.unexplained_linear_momentum = after.linear_momentum - before.linear_momentum;
    account_.unexplained_angular_momentum = after.angular_momentum - before.angular_momentum;
    for (std::size_t i = 0; i < account_.entries.size(); ++i) {
        const StepAccount::Entry& entry = account_.entries[i];
        // The work of gravity only moves energy from potential to kinetic.
        if (static_cast<StepCause>(i) != StepCause::gravity) account_.unexplained_energy -= entry.work;
        account_.unexplained_linear_momentum -= entry.linear_impulse;
        account_.unexplained_angular_momentum -= entry.angular_impulse;
    }
    return account_;
}

}  // namespace embody::physics::state
