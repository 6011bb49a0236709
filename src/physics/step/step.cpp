// SPDX-License-Identifier: MIT
#include "physics/step/step.h"

#include <optional>

#include "foundation/validate.h"
#include "foundation/zone.h"
#include "physics/stages/rigid/roll_balls.h"
#include "physics/stages/stages.h"
#include "physics/state/validate.h"
#include "physics/state/world_state.h"
#include "physics/step/report.h"

namespace embody::physics::step {

namespace {

// Runs one stage, or a part of it, with what it may touch, and notes its time. The name is its zone's.
template <class Access>
void run(WorldState& world, StepStage stage, const char* name, void (*work)(const Access&)) {
    TimedZone zone(name);
    work(Access(world));
    world.report.stage_milliseconds[static_cast<std::size_t>(stage)] += zone.finish();
}

// All stages that move bodies; nothing to do while all sleep. Workers are kept awake if the step is expected to be
// long.
void advance(WorldState& world, bool is_long) {
    std::optional<TaskPool::StayAwake> stay_awake;
    if (is_long) stay_awake.emplace(*world.workers);

    const auto account = [&](void (Ledger::*note)()) {
        if (world.ledger) (world.ledger.get()->*note)();
    };
    run(world, StepStage::find_pairs, "find pairs", find_pairs);   // broad phase
    run(world, StepStage::touch, "find contacts", find_contacts);  // narrow phase → contact regions, warm start
    run(world, StepStage::touch, "roll balls", roll_balls);  // balls alone on immovable ground: their path in the step
    run(world, StepStage::islands, "list joints", list_active_joints);
    account(&Ledger::begin_impacts);
    run(world, StepStage::impact, "solve impacts", solve_impacts);  // new, fast contacts by eq. (3)
    account(&Ledger::close_impacts);
    run(world, StepStage::islands, "find islands", find_islands);  // contact graph → islands, levels, solve order
    run(world, StepStage::substeps, "run substeps",
        run_substeps);  // kick → solve → drift → kick → solve, shock propagation
    account(&Ledger::close_limits);
    run(world, StepStage::continuous, "stop tunnelling", stop_tunnelling);  // bodies that would pass through others
    account(&Ledger::close_continuous);
    run(world, StepStage::deformables, "advance deformables",
        advance_deformables);  // nodes and elements, and their forces on bodies
    account(&Ledger::close_deformables);
    run(world, StepStage::sleep, "put to sleep", put_to_sleep);  // quiet islands leave the awake set
    account(&Ledger::close_sleep);
}

}  // namespace

void step(WorldState& world) {
    constexpr double long_step = 0.2;  // ms; to wake the workers takes 0.015
    TimedZone zone("step");
    const TaskPool::Step of_workers(*world.workers);
    const bool is_long = world.report.milliseconds > long_step;
    world.events.rope_breaks.clear();
    world.report = {.step = world.report.step + 1,
                    .time = world.report.time + world.settings.time_step,
                    .workers = world.workers->workers()};
    note_motion(FractureAccess(world));
    if (world.ledger) world.ledger->begin();
    run(world, StepStage::wake, "wake bodies", wake_bodies);  // apply commands, wake touched islands
    run(world, StepStage::fluids, "advance fluids",
        advance_fluids);  // particles, and forces of their pressure on bodies
    if (world.ledger) world.ledger->close_wake();
    if (!world.activity.awake.empty() || !world.contacts.list.empty() || world.deformables.records.count() > 0)
        advance(world, is_long);
    run(world, StepStage::fluids, "settle fluids", settle_fluids);  // liquids follow the bodies to their new places
    {
        EMBODY_ZONE("write report");
        write_report(ReportAccess(world));  // events, counts
    }
    {
        EMBODY_ZONE("break bodies");
        plan_breaks(FractureAccess(world));  // brittle bodies whose blows were too hard
    }
    if (world.ledger) world.report.account = world.ledger->finish();
    world.report.milliseconds = zone.finish();
    EMBODY_VALIDATE(validate(world));
}

}  // namespace embody::physics::step
