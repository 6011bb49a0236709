// SPDX-License-Identifier: MIT
// Fluids before the rigid bodies (docs/physics/fluids.md, "With rigid bodies"): what their pressure does to a body in
// this step is a force on it through the rigid solver's substeps, so that its contacts respond to it.
#include <algorithm>
#include <cmath>
#include <functional>

#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/fluid/fluid_ports.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/stages/fluid/immersed_deformables.h"
#include "physics/stages/fluid/sheet_response.h"
#include "physics/stages/rigid/wake.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/fluid_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

Vec3 angular_momentum_of(const FluidAccess& world, std::uint32_t slot, Vec3 angular_velocity) {
    const Quat rotation = world.rigid.motion[slot].rotation;
    return rotate(rotation, world.rigid.constants[slot].inertia * rotate_inverse(rotation, angular_velocity));
}

Vec3 at_most(Vec3 v, double most) {
    const double size = length(v);
    return size > most ? v * (most / size) : v;
}

/// Forces on a body besides the known ones, as impulses.
struct Support {
    Vec3 linear, angular;
};

// Contacts and joints are expected to have the impulses of the last step, without impacts.
Support support_of(const FluidAccess& world, std::uint32_t slot, double density) {
    const FluidTouch& touch = world.fluids.touches[slot];
    if (touch.step + 1 != world.report.step) return {};
    const double dt = world.settings.time_step;
    const BodyState& state = world.rigid.motion[slot];
    const BodyRecord& record = world.rigid.record(slot);
    const double mass = world.rigid.constants[slot].mass;
    const Vec3 linear = (state.linear_velocity - touch.linear_velocity - touch.acceleration * dt) * mass;
    const Vec3 angular =
        angular_momentum_of(world, slot, state.angular_velocity - touch.angular_velocity) - touch.torque * dt;
    const double gravity = length(world.settings.gravity), volume = record.shape->mass_properties().volume;
    const double max_support = world.settings.solver.fluid.obstacles.max_support;
    const double most = max_support * (mass * gravity + std::max(density * volume * gravity, touch.carried)) * dt;
    return {at_most(linear, most), at_most(angular, most * record.reach)};
}

Vec3 turn_between(Quat from, Quat to) {
    const Quat turn = to * conjugate(from);
    return Vec3{turn.x, turn.y, turn.z} * (turn.w < 0 ? -2.0 : 2.0);
}

// A body that only the user moves. One that was placed elsewhere moves there in this step.
FluidObstacle fixed_obstacle(const FluidAccess& world, const FluidRecord& fluid, std::uint32_t slot) {
    const BodyRecord& record = world.rigid.record(slot);
    const BodyState& state = world.rigid.motion[slot];
    const double dt = world.settings.time_step;
    FluidObstacle obstacle;
    obstacle.body = slot;
    obstacle.shape = record.shape;
    obstacle.version = record.version;
    obstacle.pose = world.rigid.pose(slot);
    obstacle.center = state.center;
    obstacle.linear_velocity = state.linear_velocity;
    obstacle.angular_velocity = state.angular_velocity;
    obstacle.is_static = record.definition.kind == BodyKind::static_body;
    const auto seen = fluid.seen.find(slot);
    if (seen == fluid.seen.end() || seen->second.version == record.version) return obstacle;
    const Vec3 local_center = world.rigid.constants[slot].local_center;
    const Vec3 last_center = transform_point(seen->second.pose, local_center);
    const Vec3 displacement = state.center - last_center,
               turn = turn_between(seen->second.pose.rotation, obstacle.pose.rotation);
    if (displacement == Vec3{} && turn == Vec3{}) return obstacle;
    // A body that was placed farther away was not moved through the fluid.
    const double jump = length(displacement) + length(turn) * record.reach;
    if (jump > world.settings.solver.fluid.obstacles.max_jump) return obstacle;
    obstacle.is_static = false;
    obstacle.pose = seen->second.pose;
    obstacle.center = last_center;
    obstacle.linear_velocity = displacement / dt;
    obstacle.angular_velocity = turn / dt;
    return obstacle;
}

FluidObstacle dynamic_obstacle(const FluidAccess& world, std::uint32_t slot, double density) {
    const BodyState& state = world.rigid.motion[slot];
    FluidObstacle obstacle;
    obstacle.body = slot;
    obstacle.shape = world.rigid.record(slot).shape;
    obstacle.version = world.rigid.record(slot).version;
    obstacle.pose = world.rigid.pose(slot);
    obstacle.center = state.center;
    if (world.activity.is_asleep(slot)) return obstacle;
    const double dt = world.settings.time_step;
    const Support support = support_of(world, slot, density);
    obstacle.linear_velocity = state.linear_velocity;
    obstacle.angular_velocity = state.angular_velocity;
    obstacle.inverse_mass = state.inverse_mass;
    obstacle.inverse_inertia = state.inverse_inertia;
    obstacle.acceleration = world.rigid.constants[slot].acceleration + support.linear * (state.inverse_mass / dt);
    obstacle.angular_acceleration = state.inverse_inertia * (world.rigid.constants[slot].torque + support.angular / dt);
    return obstacle;
}

// Slots of the bodies that the fluid may meet in this step, ascending.
std::vector<std::uint32_t> bodies_near(const FluidAccess& world, const FluidRecord& fluid) {
    const double dt = world.settings.time_step, h = fluid.definition.cell_size;
    const double displacement = (fluid.fastest + length(world.settings.gravity) * dt) * dt;
    std::vector<std::uint32_t> slots;
    world.contacts.broad_phase.query(enlarged(fluid.bounds, 4 * h + displacement), [&](std::uint32_t slot) {
        if (world.rigid.record(slot).shape && world.rigid.record(slot).definition.enabled) slots.push_back(slot);
    });
    return slots;
}

// Whether anything has happened around a sleeping fluid.
bool is_disturbed(const FluidAccess& world, const FluidRecord& fluid, const std::vector<std::uint32_t>& slots) {
    if (slots.size() != fluid.seen.size()) return true;
    for (const std::uint32_t slot : slots) {
        const auto seen = fluid.seen.find(slot);
        if (seen == fluid.seen.end() || seen->second.version != world.rigid.record(slot).version) return true;
        const BodyState& state = world.rigid.motion[slot];
        if (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{}) return true;
        if (world.rigid.is_dynamic(slot) && !world.activity.is_asleep(slot)) return true;
    }
    return false;
}

// Forces of this step on the bodies, and what is remembered of them.
void push_bodies(const FluidAccess& world, FluidRecord& fluid, std::span<const FluidObstacle> obstacles) {
    const double dt = world.settings.time_step;
    fluid.seen.clear();
    for (const FluidObstacle& obstacle : obstacles) {
        const BodyRecord& record = world.rigid.record(obstacle.body);
        fluid.seen[obstacle.body] = {record.version, world.rigid.pose(obstacle.body), obstacle.impulse / dt,
                                     obstacle.angular_impulse / dt};
    }
}

void add_forces(const FluidAccess& world, const FluidRecord& fluid) {
    for (const auto& [slot, seen] : fluid.seen) {
        if (seen.force == Vec3{} && seen.torque == Vec3{}) continue;
        world.rigid.record(slot).fluid_force += seen.force;
        world.rigid.record(slot).fluid_torque += seen.torque;
        world.fluids.pushed_bodies.push_back(slot);
    }
}

// Bodies that sleep and feel another force than when they fell asleep wake.
void wake_pushed(const FluidAccess& world) {
    const double noticed_fraction = world.settings.solver.optimization.wake_force_fraction;
    for (const std::uint32_t slot : world.fluids.pushed_bodies) {
        if (!world.rigid.is_dynamic(slot) || !world.activity.is_asleep(slot)) continue;
        const Vec3 change = world.rigid.record(slot).fluid_force - world.fluids.touches[slot].force_asleep;
        const double weight = world.rigid.constants[slot].mass * length(world.settings.gravity);
        if (length(change) > noticed_fraction * weight) wake_group_of(world, slot);
    }
}

void note_touches(const FluidAccess& world) {
    for (const std::uint32_t slot : world.fluids.pushed_bodies) {
        if (!world.rigid.is_dynamic(slot) || world.activity.is_asleep(slot)) continue;
        const BodyState& state = world.rigid.motion[slot];
        const FluidTouch& before = world.fluids.touches[slot];
        if (before.step == world.report.step) continue;  // pushed by several
        const double last = before.step + 1 == world.report.step ? length(before.force_asleep) : 0;
        const double carried = std::min(length(world.rigid.record(slot).fluid_force), last);
        world.fluids.touches[slot] = {world.report.step,
                                      state.linear_velocity,
                                      state.angular_velocity,
                                      world.rigid.constants[slot].acceleration,
                                      world.rigid.constants[slot].torque,
                                      world.rigid.record(slot).fluid_force,
                                      carried};
    }
}

void report_limit(const FluidAccess& world, StepLimit limit) {
    world.report.limits |= static_cast<std::uint32_t>(limit);
}

void note_outcome(const FluidAccess& world, FluidRecord& fluid, const FluidOutcome& outcome) {
    fluid.lost += outcome.lost;
    if (outcome.lost > 0) report_limit(world, StepLimit::fluid_particles_lost);
    if (outcome.is_slowed) report_limit(world, StepLimit::fluid_too_fast);
    if (!outcome.is_solved) report_limit(world, StepLimit::fluid_unsolved);
    if (!outcome.is_finite) {
        report_limit(world, StepLimit::not_finite_fluid_frozen);
        fluid.is_frozen = true;
        fluid.solver->put_at_rest(fluid.positions, fluid.ids);
    }
}

// Height of the particles' centre of mass, against gravity, m.
double height_of(const FluidSolver& solver, Vec3 gravity) {
    if (solver.particles().empty() || gravity == Vec3{}) return 0;
    const Vec3 up = -normalized(gravity);
    double sum = 0, mass = 0;
    for (const FluidParticle& particle : solver.particles()) {
        const double relative = solver.liquids().of(particle.id).density / solver.properties().density;
        const auto& [x, y, z] = particle.position;
        sum += dot(up, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}) * relative;
        mass += relative;
    }
    return sum / mass;
}

// Running honey is slower than the jitter of water at rest: liquid that still sinks as a whole does not sleep.
bool has_sunk(const FluidAccess& world, const FluidRecord& fluid) {
    const double sunk = fluid.quiet_height - height_of(*fluid.solver, world.settings.gravity);
    const double max_sinking_speed = world.settings.solver.fluid.sleep.max_sinking_speed;
    return sunk > max_sinking_speed * fluid.definition.cell_size * fluid.quiet_time;
}

void fall_asleep_if_quiet(const FluidAccess& world, FluidRecord& fluid) {
    const double quiet_speed = world.settings.solver.fluid.sleep.quiet_speed,
                 time_to_sleep = world.settings.solver.fluid.sleep.time_to_sleep;
    const Vec3 gravity = world.settings.gravity * fluid.definition.gravity_factor;
    const bool is_quiet =
        fluid.solver->particles().empty() ||
        (fluid.solver->usual_speed(world.workers) < quiet_speed && !fluid.solver->is_top_heavy(gravity));
    if (is_quiet && fluid.quiet_time == 0) fluid.quiet_height = height_of(*fluid.solver, world.settings.gravity);
    fluid.quiet_time = is_quiet ? fluid.quiet_time + world.settings.time_step : 0;
    if (fluid.quiet_time >= time_to_sleep && has_sunk(world, fluid)) fluid.quiet_time = 0;
    if (!is_quiet) {
        // A floating body is quiet at its turning points, too: it waits for the liquid to sleep.
        for (const auto& [slot, seen] : fluid.seen) {
            if (seen.force != Vec3{}) world.activity.sleep[slot].quiet_time = 0;
        }
        keep_immersed_awake(world, fluid);
    }
    if (fluid.quiet_time < time_to_sleep || !world.settings.sleeping || !fluid.definition.allow_sleep) return;
    for (const auto& [slot, seen] : fluid.seen) {
        const BodyState& state = world.rigid.motion[slot];
        if (world.rigid.is_dynamic(slot) && !world.activity.is_asleep(slot)) return;
        if (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{}) return;
    }
    if (!are_immersed_asleep(world, fluid)) return;
    fluid.is_asleep = true;
    fluid.solver->stop();
    read_particles(fluid, world.workers);
}

std::vector<FluidObstacle> obstacles_near(const FluidAccess& world, const FluidRecord& fluid,
                                          const std::vector<std::uint32_t>& slots) {
    double density = 0;
    for (const FluidProperties& liquid : fluid.solver->liquids().liquids()) density = std::max(density, liquid.density);
    std::vector<FluidObstacle> obstacles;
    obstacles.reserve(slots.size());
    for (const std::uint32_t slot : slots) {
        obstacles.push_back(world.rigid.is_dynamic(slot) ? dynamic_obstacle(world, slot, density)
                                                         : fixed_obstacle(world, fluid, slot));
    }
    return obstacles;
}

void advance_fluid(const FluidAccess& world, FluidRecord& fluid) {
    const std::vector<std::uint32_t> slots = bodies_near(world, fluid);
    const std::vector<std::uint32_t> bending = deformables_near(world, fluid);
    const auto is_touched = [&] {
        return is_disturbed(world, fluid, slots) || have_deformables_changed(world, fluid, bending);
    };
    if (fluid.is_asleep && !is_touched()) return;
    if (fluid.is_asleep) fluid.quiet_time = 0;
    fluid.is_asleep = false;
    const TaskPool::StayAwake stay_awake(world.workers);
    std::vector<FluidObstacle> obstacles = obstacles_near(world, fluid, slots);
    fluid.solver->set_settings(world.settings.solver.fluid);
    ImmersedDeformables immersed = immerse(world, fluid, bending);
    SheetResponse sheets(world, immersed);
    const PointResponse respond = sheets.is_empty() ? PointResponse() : std::ref(sheets);
    const FluidOutcome outcome =
        fluid.solver->advance(world.settings.time_step, world.settings.gravity * fluid.definition.gravity_factor,
                              obstacles, world.workers, immersed.points, respond);
    note_outcome(world, fluid, outcome);
    push_bodies(world, fluid, obstacles);
    note_forces(world, fluid, immersed);
    if (fluid.is_frozen) read_particles(fluid, world.workers);
    fall_asleep_if_quiet(world, fluid);
}

// Keeps particles outside of the bodies at their new places.
void follow_bodies(const FluidAccess& world, FluidRecord& fluid) {
    std::vector<std::uint32_t> slots;
    for (const auto& [slot, seen] : fluid.seen) {
        if (world.rigid.is_used(slot)) slots.push_back(slot);
    }
    std::vector<FluidObstacle> obstacles = obstacles_near(world, fluid, slots);
    fluid.solver->set_settings(world.settings.solver.fluid);
    const FluidSolver::Followed followed = fluid.solver->follow(obstacles, world.workers);
    fluid.lost += followed.lost;
    if (followed.lost > 0) report_limit(world, StepLimit::fluid_particles_lost);
    if (!followed.is_solved) report_limit(world, StepLimit::fluid_unsolved);
    read_particles(fluid, world.workers);
}

}  // namespace

void prepare_fluid(const FluidAccess& world, FluidRecord& fluid) {
    world.fluids.touches.resize(world.rigid.bodies.slot_count());
    std::vector<FluidObstacle> obstacles = obstacles_near(world, fluid, bodies_near(world, fluid));
    fluid.solver->set_settings(world.settings.solver.fluid);
    fluid.solver->prepare(obstacles, world.workers);
}

void advance_fluids(const FluidAccess& world) {
    for (const std::uint32_t slot : world.fluids.pushed_bodies) {
        if (world.rigid.is_used(slot))
            world.rigid.record(slot).fluid_force = world.rigid.record(slot).fluid_torque = {};
    }
    const bool had_pushed = !world.fluids.pushed_bodies.empty();
    world.fluids.pushed_bodies.clear();
    begin_immersed(world);
    run_fluid_ports(world);
    if (world.fluids.records.count() == 0 && !had_pushed) return;
    world.fluids.touches.resize(world.rigid.bodies.slot_count());
    for (std::uint32_t slot = 0; slot < world.fluids.records.slot_count(); ++slot) {
        if (!world.fluids.records.used(slot) || world.fluids.records.at(slot).is_frozen) continue;
        gather_awake(world);
        advance_fluid(world, world.fluids.records.at(slot));
        add_forces(world, world.fluids.records.at(slot));
        push_immersed(world, world.fluids.records.at(slot));
    }
    end_immersed(world);
    wake_pushed(world);
    gather_awake(world);
    note_touches(world);
}

void settle_fluids(const FluidAccess& world) {
    for (std::uint32_t slot = 0; slot < world.fluids.records.slot_count(); ++slot) {
        if (!world.fluids.records.used(slot)) continue;
        FluidRecord& fluid = world.fluids.records.at(slot);
        if (fluid.is_frozen || fluid.is_asleep) continue;
        const TaskPool::StayAwake stay_awake(world.workers);
        settle_immersed(world, fluid);
        follow_bodies(world, fluid);
    }
}

}  // namespace embody::physics::stages
