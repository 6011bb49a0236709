// SPDX-License-Identifier: MIT
#include <cmath>

#include "physics/constraint/substep_solver.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/optimization/shock_propagation.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

void solve_islands(WorldState& world, SolvePhase phase, double h) {
    const Islands& islands = world.islands;
    for (const Island& island : islands.list) {
        const ConstraintList list{
            .contacts = world.contacts,
            .contact_order = std::span(islands.contacts).subspan(island.first_contact, island.contact_count),
            .joints = world.active_joints,
            .joint_order = std::span(islands.joints).subspan(island.first_joint, island.joint_count)};
        solve_phase(list, phase, h, world.motion);
    }
}

// Free bodies and jointed ones get half of the forces before the drift and half after it, which is exact for a constant
// force and symplectic for joints. Where there are contacts all of it comes first: resting bodies then have the
// velocity that the contacts must hold, and the warm start fits.
bool has_split_kick(const Island& island) { return island.contact_count == 0; }

void kick_before_drift(WorldState& world, double h) {
    for (const Island& island : world.islands.list) {
        const double time = has_split_kick(island) ? h / 2 : h;
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            kick(world.motion[body], world.constants[body], time);
            split_gyroscopic(world.motion[body], world.constants[body], h);
            world.kicked_velocity[body] = world.motion[body].linear_velocity;
        }
    }
}

void kick_after_drift(WorldState& world, double h) {
    for (const Island& island : world.islands.list) {
        if (!has_split_kick(island)) continue;
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            kick(world.motion[body], world.constants[body], h / 2);
        }
    }
}

void drift_all(WorldState& world, double h) {
    for (const Island& island : world.islands.list) {
        for (std::uint32_t k = 0; k < island.body_count; ++k) {
            const std::uint32_t body = world.islands.bodies[island.first_body + k];
            BodyState& state = world.motion[body];

            // A body near others that nothing touched: its mean velocity lies half a kick behind.
            const bool is_free = state.linear_velocity == world.kicked_velocity[body];
            if (!has_split_kick(island) && is_free) state.center -= world.constants[body].acceleration * (h * h / 2);
            drift(state, world.constants[body], h);
        }
    }
    for (const std::uint32_t body : world.awake) {
        if (world.motion[body].inverse_mass == 0) drift_kinematic(world.motion[body], h);
    }
}

void prepare_joints(WorldState& world) {
    for (Joint& joint : world.active_joints) prepare_joint(joint, world.motion);
}

bool is_state_finite(const BodyState& state) {
    return is_finite(state.center) && is_finite(state.rotation) && is_finite(state.linear_velocity) &&
           is_finite(state.angular_velocity);
}

// A body that left the finite numbers would take all it touches along: it is put back and switched off.
void freeze_lost_bodies(WorldState& world) {
    for (const std::uint32_t body : world.awake) {
        BodyState& state = world.motion[body];
        BodyRecord& record = world.record(body);
        if (is_state_finite(state) && length(state.center) < 1e15) {
            record.last_center = state.center;
            record.last_rotation = state.rotation;
            continue;
        }
        state.center = record.last_center;
        state.rotation = record.last_rotation;
        state.linear_velocity = state.angular_velocity = {};
        record.definition.enabled = false;
        world.broad_phase.remove(body);
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen);
    }
}

void clamp_speeds(WorldState& world) {
    for (const std::uint32_t body : world.islands.bodies) {
        Vec3& velocity = world.motion[body].linear_velocity;
        const double speed = length(velocity);
        if (!(speed > world.settings.max_linear_speed)) continue;
        velocity *= world.settings.max_linear_speed / speed;
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::linear_speed_clamped);
    }
}

}  // namespace

void run_substeps(WorldState& world) {
    const double h = world.settings.time_step / world.settings.substeps;
    for (Contact& contact : world.contacts) prepare_contact(contact, world.motion);
    prepare_joints(world);
    world.kicked_velocity.resize(world.motion.size());

    for (int k = 1; k <= world.settings.substeps; ++k) {
        // Forces, constraints that also mend positions, motion.
        for (Contact& contact : world.contacts) activate_points(contact, k * h);
        kick_before_drift(world, h);
        solve_islands(world, SolvePhase::position, h);
        drift_all(world, h);

        // Constraints on the velocity alone.
        prepare_joints(world);
        kick_after_drift(world, h);
        solve_islands(world, SolvePhase::velocity, h);
        for (Contact& contact : world.contacts) add_to_totals(contact);
    }

    if (world.settings.shock_propagation) {
        for (const Island& island : world.islands.list) {
            propagate_shock(island, world.islands, world.contacts, contact_softness(h, island.contact_count),
                            world.motion);
        }
    }
    clamp_speeds(world);
    freeze_lost_bodies(world);
    for (std::size_t i = 0; i < world.active_joints.size(); ++i) {
        world.joints.at(world.active_joint_slots[i]).constraint = world.active_joints[i];
    }
}

}  // namespace embody::physics
