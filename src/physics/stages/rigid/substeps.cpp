// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cmath>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/constraint/sweeps/substep_solver.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/optimization/direct_islands.h"
#include "physics/optimization/islands.h"
#include "physics/optimization/shock_propagation.h"
#include "physics/optimization/solve_schedule.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/rigid/roll.h"
#include "physics/stages/rigid/roll_balls.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/ledger.h"
#include "physics/state/rigid_state.h"
#include "physics/state/substep_memory.h"

namespace embody::physics::stages {

namespace {

std::span<const std::uint32_t> contacts_of(const SubstepAccess& world, const Island& island) {
    return std::span(world.islands.contacts).subspan(island.first_contact, island.contact_count);
}

std::span<const std::uint32_t> joints_of(const SubstepAccess& world, const Island& island) {
    return std::span(world.islands.joints).subspan(island.first_joint, island.joint_count);
}

std::span<const std::uint32_t> bodies_of(const SubstepAccess& world, const Island& island) {
    return std::span(world.islands.bodies).subspan(island.first_body, island.body_count);
}

const ConstraintSettings& constraint_settings(const SubstepAccess& world) { return world.settings.solver.constraint; }

JointSystem::View joint_view(const SubstepAccess& world) {
    return {world.rigid.motion, world.rigid.constants, world.joints.active, constraint_settings(world).joint};
}

ContactPlan plan_of(const SubstepAccess& world, const Island& island) {
    return contact_plan(island.contact_count, world.settings.substeps, constraint_settings(world).contact);
}

ContactSoftness softness_of(const SubstepAccess& world, const ContactPlan& plan) {
    return plan.softness(world.settings.time_step, constraint_settings(world).contact);
}

JointedList jointed_list(const SubstepAccess& world, const Island& island) {
    return {bodies_of(world, island), joints_of(world, island)};
}

// The system that solves the island's joints at once; null where there are none or too many.
JointSystem* joint_system(const SubstepAccess& world, const Island& island) {
    if (island.joint_count == 0 || !JointSystem::fits(jointed_list(world, island))) return nullptr;
    return &world.substeps.joint_systems[world.islands.bodies[island.first_body]];
}

// The kinematic bodies in motion.
void list_carriers(const SubstepAccess& world, std::vector<std::uint32_t>& carriers) {
    carriers.clear();
    if (world.activity.awake.size() == world.islands.bodies.size()) return;
    for (const std::uint32_t body : world.activity.awake) {
        const BodyState& state = world.rigid.motion[body];
        const bool moves = state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{};
        if (state.inverse_mass == 0 && moves) carriers.push_back(body);
    }
}

// Whether a kinematic body may add energy to the island by a contact.
bool is_pushed(const SubstepAccess& world, const Island& island) {
    const auto pushes = [&](std::uint32_t body) {
        const BodyState& state = world.rigid.motion[body];
        return state.inverse_mass == 0 && (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{});
    };
    const auto contacts = contacts_of(world, island);
    return std::any_of(contacts.begin(), contacts.end(), [&](std::uint32_t index) {
        return pushes(world.contacts.list[index].a) || pushes(world.contacts.list[index].b);
    });
}

// Whether the inertia of some body turns with it in this step: then the contacts' frozen axes are not the body's, and
// impulses that held in the last step may push in this one.
bool spins(const SubstepAccess& world, const Island& island) {
    const auto bodies = bodies_of(world, island);
    return std::any_of(bodies.begin(), bodies.end(), [&](std::uint32_t body) {
        return has_gyroscopic_torque(world.rigid.motion[body], world.rigid.constants[body], world.settings.time_step);
    });
}

// Solves all given islands, of contacts only, through the step.
void solve_wide(const SubstepAccess& world, const IslandsBySolver::Wide& group) {
    EMBODY_ZONE("solve wide");
    if (group.islands.empty()) return;
    std::vector<std::uint32_t>&order = world.substeps.wide_contacts, &bodies = world.substeps.wide_bodies;
    std::vector<WideContactSolver::Group>& groups = world.substeps.wide_groups;
    order.clear();
    bodies.clear();
    groups.clear();
    list_carriers(world, world.substeps.wide_carriers);
    for (const Island& island : group.islands) {
        groups.push_back({island.body_count, spins(world, island) && !is_pushed(world, island)});
        const auto contacts = contacts_of(world, island);
        order.insert(order.end(), contacts.begin(), contacts.end());
        const auto members = bodies_of(world, island);
        bodies.insert(bodies.end(), members.begin(), members.end());
    }
    WideContactSolver& solver = world.substeps.wide_solver;
    build_schedule(order, world.contacts.summaries, world.rigid.motion, solver.lanes(), world.substeps.schedule);
    const ContactSoftness softness = softness_of(world, group.plan);
    solver.begin({bodies, world.substeps.wide_carriers, groups}, softness.substep, group.plan.substeps);
    for (const SolveSchedule::Stage& stage : world.substeps.schedule.stages) {
        solver.begin_stage();
        for (std::uint32_t i = 0; i < stage.batch_count; ++i) {
            const SolveSchedule::Batch& batch = world.substeps.schedule.batches[stage.first_batch + i];
            solver.add_batch(std::span(world.substeps.schedule.contacts).subspan(batch.first, batch.count),
                             batch.points);
        }
    }
    solver.solve(group.plan.passes, softness, world.rigid.motion, world.rigid.constants, world.contacts.list,
                 world.contacts.summaries, world.workers);
    if (!world.ledger) return;
    for (const std::uint32_t body : bodies) world.ledger->note_kept_fraction(body, solver.kept_fraction(body));
}

// Stores what the report needs of each contact; the wide solver stores that of its own contacts.
void note_outcomes(const SubstepAccess& world, const Island& island) {
    for (const std::uint32_t contact : contacts_of(world, island)) {
        world.contacts.summaries[contact].touches = is_touching(world.contacts.list[contact]);
    }
}

// Whether the last step's impulses held the island, and nothing in it has changed since.
bool is_still_held(const SubstepAccess& world, const Island& island) {
    const auto bodies = bodies_of(world, island);
    const auto contacts = contacts_of(world, island);
    const auto stands = [&](std::uint32_t body) {
        const HeldRecord& held = world.substeps.held[body];
        return world.contacts.touch.bodies[body].stands && held.step + 1 == world.report.step &&
               held.contacts == island.contact_count;
    };
    const auto is_kept = [&](std::uint32_t contact) { return world.contacts.summaries[contact].is_kept; };
    return std::all_of(bodies.begin(), bodies.end(), stands) && std::all_of(contacts.begin(), contacts.end(), is_kept);
}

void note_held(const SubstepAccess& world, const Island& island) {
    for (const std::uint32_t body : bodies_of(world, island)) {
        world.substeps.held[body] = {world.report.step, island.contact_count};
    }
}

// Whether the island was solved directly; else the sweeps have to.
bool solve_directly(const SubstepAccess& world, const Island& island) {
    // Impulses are scaled as those of the sweeps, so that either solver can continue from the other.
    const int parts = plan_of(world, island).substeps;
    const DirectContactSolver::List list{bodies_of(world, island), contacts_of(world, island), parts};
    if (is_still_held(world, island)) {
        DirectContactSolver::hold(list, world.contacts.list);
        note_held(world, island);
        note_outcomes(world, island);
        return true;
    }
    const DirectUse use = direct_use_of(island, world.islands, world.contacts.list, world.rigid.motion,
                                        world.settings.solver.optimization);
    if (use == DirectUse::never) return false;
    using Effort = DirectContactSolver::Effort;
    const Effort effort = use == DirectUse::always ? Effort::any : Effort::while_slow;
    using Outcome = DirectContactSolver::Outcome;
    const Outcome outcome = world.substeps.direct_solver.solve(list, effort, world.rigid.motion, world.rigid.constants,
                                                               world.contacts.list);
    if (outcome == Outcome::unsolved) return false;
    if (outcome == Outcome::held) note_held(world, island);
    note_outcomes(world, island);
    return true;
}

// The systems of islands that are gone or asleep are dropped.
void set_up_joint_systems(const SubstepAccess& world) {
    std::map<std::uint32_t, JointSystem> last = std::move(world.substeps.joint_systems);
    world.substeps.joint_systems.clear();
    for (const Island& island : world.islands.list) {
        const JointedList list = jointed_list(world, island);
        if (list.joints.empty() || !JointSystem::fits(list)) continue;
        auto known = last.extract(list.bodies.front());
        JointSystem& system = known.empty() ? world.substeps.joint_systems[list.bodies.front()]
                                            : world.substeps.joint_systems.insert(std::move(known)).position->second;
        system.set(list, joint_view(world));
    }
}

// Joints only: each island through the whole step. Kinematic bodies go along; others take them from where they were.
void solve_jointed(const SubstepAccess& world, const std::vector<Island>& islands, double h) {
    EMBODY_ZONE("solve jointed");
    const JointSystem::View view = joint_view(world);
    for (const Island& island : islands) {
        JointSystem& system = *joint_system(world, island);
        std::vector<std::pair<std::uint32_t, BodyState>>& carriers = world.substeps.carriers;
        system.list_carriers(view, carriers);
        for (int k = 0; k < world.settings.substeps; ++k) {
            system.advance(h, view);
            if (world.ledger) world.ledger->close_island(island, h);
        }
        for (const auto& [body, state] : carriers) world.rigid.motion[body] = state;
    }
}

// Solves the islands that are solved directly; says how the others are to be solved.
const IslandsBySolver& sort_islands(const SubstepAccess& world) {
    EMBODY_ZONE("choose solvers");
    IslandsBySolver& sorted = world.substeps.islands;
    sorted.clear();
    set_up_joint_systems(world);
    world.substeps.held.resize(world.rigid.bodies.slot_count());
    world.substeps.direct_solver.begin(world.settings.time_step, world.settings.substeps, constraint_settings(world));
    for (const Island& island : world.islands.list) {
        if (take_rolled_balls(world, island)) {
            note_outcomes(world, island);
            for (const std::uint32_t body : bodies_of(world, island)) {
                if (world.ledger) world.ledger->note_rolled(body);
            }
        } else if (island.contact_count == 0 && island.joint_count == 0) {
            sorted.free.push_back(world.islands.bodies[island.first_body]);
        } else if (island.contact_count == 0 && joint_system(world, island)) {
            sorted.jointed.push_back(island);
        } else if (island.joint_count > 0) {
            sorted.one_by_one.push_back(island);
        } else if (roll_alone(world, island)) {
            note_outcomes(world, island);
            if (world.ledger) world.ledger->note_rolled(world.islands.bodies[island.first_body]);
        } else if (!solve_directly(world, island)) {
            sorted.add(island, plan_of(world, island));
        }
    }
    return sorted;
}

void solve_islands(const SubstepAccess& world, const std::vector<Island>& islands, SolvePhase phase, double h,
                   double time) {
    std::size_t first = 0;
    for (const Island& island : islands) {
        const ConstraintList list{
            .contacts = world.contacts.list,
            .contact_order = std::span(world.islands.contacts).subspan(island.first_contact, island.contact_count),
            .prepared = std::span(world.substeps.prepared_contacts).subspan(first, island.contact_count),
            .joints = world.joints.active,
            .joint_order = joints_of(world, island),
            .system = joint_system(world, island),
            .settings = constraint_settings(world)};
        solve_phase(list, phase, h, time, world.rigid.motion, world.rigid.constants);
        first += island.contact_count;
    }
}

// Calls visit(contact) for each contact of the islands.
template <class Visit>
void for_each_contact(const SubstepAccess& world, const std::vector<Island>& islands, Visit visit) {
    for (const Island& island : islands) {
        for (std::uint32_t k = 0; k < island.contact_count; ++k) {
            visit(world.contacts.list[world.islands.contacts[island.first_contact + k]]);
        }
    }
}

// Free bodies and jointed ones get half of the forces before the drift and half after it, which is exact for a constant
// force and symplectic for joints. Where there are contacts all of it comes first: resting bodies then have the
// velocity that the contacts must stop, and the warm start fits.
bool has_split_kick(const Island& island) { return island.contact_count == 0; }

void kick_before_drift(const SubstepAccess& world, const std::vector<Island>& islands, double h) {
    for (const Island& island : islands) {
        const double time = has_split_kick(island) ? h / 2 : h;
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            kick(world.rigid.motion[body], world.rigid.constants[body], time);
            split_gyroscopic(world.rigid.motion[body], world.rigid.constants[body], h);
            world.substeps.kicked_velocity[body] = world.rigid.motion[body].linear_velocity;
        }
    }
}

void kick_after_drift(const SubstepAccess& world, const std::vector<Island>& islands, double h) {
    for (const Island& island : islands) {
        if (!has_split_kick(island)) continue;
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            kick(world.rigid.motion[body], world.rigid.constants[body], h / 2);
        }
    }
}

void drift_all(const SubstepAccess& world, const std::vector<Island>& islands, double h) {
    for (const Island& island : islands) {
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            BodyState& state = world.rigid.motion[body];

            // A body that touched nothing: its mean velocity is half a kick behind.
            const bool is_free = state.linear_velocity == world.substeps.kicked_velocity[body];
            if (!has_split_kick(island) && is_free)
                state.center -= world.rigid.constants[body].acceleration * (h * h / 2);
            drift(state, world.rigid.constants[body], h);
        }
    }
    for (const std::uint32_t body : world.activity.awake) {
        if (world.rigid.motion[body].inverse_mass == 0) drift_kinematic(world.rigid.motion[body], h);
    }
}

void prepare_joints(const SubstepAccess& world, const std::vector<Island>& islands) {
    for (const Island& island : islands) {
        for (const std::uint32_t index : joints_of(world, island)) {
            Joint& joint = world.joints.active[index];
            prepare_joint(joint, world.rigid.motion);
            if (!joint_system(world, island)) factor_joint(joint, world.rigid.motion);
        }
    }
}

bool is_state_finite(const BodyState& state) {
    return is_finite(state.center) && is_finite(state.rotation) && is_finite(state.linear_velocity) &&
           is_finite(state.angular_velocity);
}

// Removes non-finite impulses of a lost body from what it touched.
void clear_traces_of_lost(const SubstepAccess& world) {
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.is_used(body) || world.rigid.is_dynamic(body) || is_state_finite(world.rigid.motion[body]))
            continue;
        world.rigid.motion[body].linear_velocity = world.rigid.motion[body].angular_velocity = {};
    }
    for (std::size_t i = 0; i < world.contacts.list.size(); ++i) {
        Contact& contact = world.contacts.list[i];
        if (world.rigid.record(contact.a).definition.enabled && world.rigid.record(contact.b).definition.enabled)
            continue;
        world.contacts.summaries[i].touches = false;
        for (ContactPoint& point : contact.points) point.impulse = point.total = 0;
        contact.friction = contact.friction_total = {};
        contact.rolling = {};
    }

    // Joints are solved together: what is no number in one is so in those beside it.
    for (Joint& joint : world.joints.active) {
        const bool is_of_lost = !world.rigid.record(joint.b).definition.enabled ||
                                (!joint.a_is_world && !world.rigid.record(joint.a).definition.enabled);
        if (is_of_lost || !is_finite(joint.total_linear) || !is_finite(joint.total_angular)) forget_impulses(joint);
    }
}

bool is_lost(const BodyState& state) {
    constexpr double farthest = 1e15;  // m: there doubles lie 0.1 m apart
    return !is_state_finite(state) || !(length(state.center) < farthest);
}

// A body with a non-finite state would spread it to all that it touches: it is put back and disabled.
void freeze_lost_bodies(const SubstepAccess& world) {
    std::atomic<bool> lost_any{false};
    for_each_awake(world, [&](std::uint32_t body) {
        const BodyState& state = world.rigid.motion[body];
        if (is_lost(state)) {
            lost_any = true;
            return;
        }
        world.rigid.record(body).last_center = state.center;
        world.rigid.record(body).last_rotation = state.rotation;
    });
    if (!lost_any) return;
    for (const std::uint32_t body : world.activity.awake) {
        BodyState& state = world.rigid.motion[body];
        BodyRecord& record = world.rigid.record(body);
        if (!is_lost(state)) continue;
        state.center = record.last_center;
        state.rotation = record.last_rotation;
        state.linear_velocity = state.angular_velocity = {};
        record.definition.enabled = false;
        world.activity.awake_changed = true;
        if (record.shape) world.contacts.broad_phase.remove(body);
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen);
    }
    clear_traces_of_lost(world);
}

// Alternating sweeps over joints and contacts may not converge, and oscillations of their error must not grow. A
// substep does not end with more energy than the forces add; before the drift, energy may also come from bodies that
// are separated and errors that are corrected.
class EnergyBounds {
public:
    EnergyBounds(const SubstepAccess& world, const std::vector<Island>& islands)
        : world_(world), view_(joint_view(world)), bounds_(world.substeps.energy_bounds) {
        bounds_.clear();
        const double speed = constraint_settings(world).contact.max_correction_speed;
        for (const Island& island : islands) {
            const JointSystem* system = island.contact_count > 0 ? joint_system(world, island) : nullptr;
            if (!system || is_pushed(world, island)) continue;
            bounds_.push_back({island, system, 0, system->mass(view_) * speed * speed / 2});
        }
    }
    void note() {
        for (Bound& bound : bounds_) bound.energy = bound.system->kinetic_energy(view_);
    }
    void keep_before_drift() const {
        for (const Bound& bound : bounds_) keep(bound, bound.energy + bound.correction);
    }
    void keep() const {
        for (const Bound& bound : bounds_) keep(bound, bound.energy);
    }

private:
    using Bound = SubstepMemory::EnergyBound;
    void keep(const Bound& bound, double most) const {
        const double fraction = bound.system->bound_energy(most, view_);
        if (world_.ledger && fraction < 1) {
            for (const std::uint32_t body : bodies_of(world_, bound.island)) {
                world_.ledger->note_scaled(body, fraction);
            }
        }
        // Impulses that added so much energy are no guess for the next ones.
        if (fraction > view_.settings.warm_start_kept_fraction) return;
        for (const std::uint32_t index : contacts_of(world_, bound.island)) {
            Contact& contact = world_.contacts.list[index];
            for (ContactPoint& point : contact.points) point.impulse = 0;
            contact.friction = {};
            contact.rolling = {};
        }
    }

    const SubstepAccess world_;
    JointSystem::View view_;
    std::vector<Bound>& bounds_;
};

// Through the whole step: half of the forces before the drift and half after it.
void solve_free(const SubstepAccess& world, const std::vector<std::uint32_t>& bodies, double h) {
    EMBODY_ZONE("move free bodies");
    constexpr std::size_t min_parallel_count = 200;  // bodies: below, waking the workers costs more
    parallel_for(world.workers, bodies.size(), bodies.size() >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            BodyState& state = world.rigid.motion[bodies[i]];
            const BodyConstants& constants = world.rigid.constants[bodies[i]];
            for (int k = 0; k < world.settings.substeps; ++k) fly(state, constants, h);
        }
    });
}

// Islands with joints and contacts: one constraint after the other, in double. Moves the kinematic bodies too.
void solve_one_by_one(const SubstepAccess& world, const std::vector<Island>& islands, double h) {
    EMBODY_ZONE("solve one by one");
    world.substeps.prepared_contacts.clear();
    for_each_contact(world, islands, [&](Contact& contact) {
        world.substeps.prepared_contacts.push_back(prepare_contact(contact, world.rigid.motion));
    });
    prepare_joints(world, islands);
    world.substeps.kicked_velocity.resize(world.rigid.motion.size());
    EnergyBounds energy_bounds(world, islands);
    for (int k = 1; k <= world.settings.substeps; ++k) {
        // Forces, constraints that also correct positions, motion.
        kick_before_drift(world, islands, h);
        energy_bounds.note();
        solve_islands(world, islands, SolvePhase::position, h, k * h);
        energy_bounds.keep_before_drift();
        drift_all(world, islands, h);

        // Constraints on the velocity alone.
        prepare_joints(world, islands);
        kick_after_drift(world, islands, h);
        solve_islands(world, islands, SolvePhase::velocity, h, k * h);
        energy_bounds.keep();
        for_each_contact(world, islands, [](Contact& contact) { add_to_totals(contact); });
        for (const Island& island : islands) {
            if (world.ledger) world.ledger->close_island(island, h);
        }
    }
    for (const Island& island : islands) note_outcomes(world, island);
}

// Velocities of jointed bodies at the step's start.
void note_held_starts(const SubstepAccess& world) {
    std::vector<SubstepMemory::HeldStart>& starts = world.substeps.held_starts;
    starts.clear();
    if (world.joints.active.empty()) return;
    for (const Island& island : world.islands.list) {
        if (island.joint_count == 0) continue;
        for (const std::uint32_t body : bodies_of(world, island)) {
            starts.push_back(
                {body, world.rigid.motion[body].linear_velocity, world.rigid.motion[body].angular_velocity});
        }
    }
}

// Acceleration of these by joints and contacts since then.
void note_held_accelerations(const SubstepAccess& world) {
    std::vector<ImpactMemory::HeldAcceleration>& accelerations = world.impacts.held_accelerations;
    accelerations.clear();
    if (world.substeps.held_starts.empty()) return;
    accelerations.resize(world.rigid.motion.size());
    const double time = world.settings.time_step;
    for (const SubstepMemory::HeldStart& start : world.substeps.held_starts) {
        const BodyState& now = world.rigid.motion[start.body];
        const Vec3 change = (now.linear_velocity - start.linear_velocity) / time;
        const double turning = length(now.angular_velocity - start.angular_velocity) / time;
        accelerations[start.body] = {to_vec3f(change - world.rigid.constants[start.body].acceleration),
                                     static_cast<float>(turning * world.rigid.record(start.body).reach)};
    }
}

void propagate_shocks(const SubstepAccess& world, const IslandsBySolver& sorted) {
    EMBODY_ZONE("propagate shocks");
    const auto propagate = [&](const Island& island, const ContactPlan& plan) {
        propagate_shock(island, world.islands, world.contacts.list,
                        {world.settings.solver.optimization, softness_of(world, plan)}, world.rigid.motion);
    };
    const auto is_sunk = [&](std::uint32_t contact) { return world.contacts.summaries[contact].is_sunk; };
    for (const IslandsBySolver::Wide& group : sorted.wide) {
        for (const Island& island : group.islands) {
            const auto contacts = contacts_of(world, island);
            if (std::any_of(contacts.begin(), contacts.end(), is_sunk)) propagate(island, group.plan);
        }
    }
    for (const Island& island : sorted.one_by_one) {
        propagate(island, jointed_contact_plan(island.contact_count, world.settings.substeps,
                                               constraint_settings(world).contact));
    }
}

}  // namespace

void run_substeps(const SubstepAccess& world) {
    const double h = world.settings.time_step / world.settings.substeps;
    note_held_starts(world);
    const IslandsBySolver& sorted = sort_islands(world);

    // The last one moves the kinematic bodies, which the others take from where the step found them.
    for (const IslandsBySolver::Wide& group : sorted.wide) solve_wide(world, group);
    solve_jointed(world, sorted.jointed, h);
    solve_free(world, sorted.free, h);
    solve_one_by_one(world, sorted.one_by_one, h);
    if (world.settings.shock_propagation) propagate_shocks(world, sorted);
    note_held_accelerations(world);
    if (world.ledger) world.ledger->close_substeps();
    limit_speeds({world.settings, world.activity, world.workers, world.report, world.rigid});
    freeze_lost_bodies(world);
    for (std::size_t i = 0; i < world.joints.active.size(); ++i) {
        world.joints.records.at(world.joints.active_slots[i]).constraint = world.joints.active[i];
    }
}

}  // namespace embody::physics::stages
