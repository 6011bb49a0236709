// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/optimization/islands.h"
#include "physics/state/activity_state.h"
#include "physics/state/ball_memory.h"
#include "physics/state/contact_state.h"
#include "physics/state/deformable_state.h"
#include "physics/state/event_state.h"
#include "physics/state/fluid_state.h"
#include "physics/state/fracture_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/ledger.h"
#include "physics/state/namespace.h"
#include "physics/state/rigid_state.h"
#include "physics/state/substep_memory.h"

namespace embody::physics::state {

/// Everything a world remembers, in parts. Each stage of the step is given the parts that it may touch
/// (stages/access.h).
/// Each array of a part names the stage that writes it; "face" is World, between steps.
struct WorldState {
    WorldSettings settings;
    std::unique_ptr<TaskPool> workers = std::make_unique<TaskPool>(1);

    RigidState rigid;
    JointState joints;
    ContactState contacts;
    ActivityState activity;
    DeformableState deformables;
    FluidState fluids;

    // Memory of the stages.
    Islands islands;  // islands
    ImpactMemory impacts;
    BallMemory balls;
    SubstepMemory substeps;
    FractureState fracture;

    // Events and reports of a step.
    EventState events;
    StepReport report;               // all
    std::unique_ptr<Ledger> ledger;  // face; all: what changed energy and momenta; null: not asked for
};

}  // namespace embody::physics::state
