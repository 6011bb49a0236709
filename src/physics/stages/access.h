// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/namespace.h"

namespace embody {
class TaskPool;
}

namespace embody::physics {
struct StepReport;
struct WorldSettings;
}  // namespace embody::physics

namespace embody::physics::optimization {
struct Islands;
}

namespace embody::physics::state {
class Ledger;
struct ActivityState;
struct BallMemory;
struct ContactState;
struct DeformableState;
struct EventState;
struct FluidState;
struct FractureState;
struct ImpactMemory;
struct JointState;
struct RigidState;
struct SubstepMemory;
struct WorldState;
}  // namespace embody::physics::state

namespace embody::physics::stages {

// The parts of the world that each stage of a step may touch; a stage only reads const members. An access is a view of
// a world's parts and lives no longer than the world; copies refer to the same world. A ledger is null where no account
// is kept.

/// Limits of speed, before a step, for velocities that users set, and after its substeps.
struct SpeedAccess {
    const WorldSettings& settings;
    const ActivityState& activity;
    TaskPool& workers;
    StepReport& report;
    RigidState& rigid;
};

/// Waking: also for stages that find a sleeper touched.
struct WakeAccess {
    explicit WakeAccess(WorldState& world);
    const WorldSettings& settings;
    const JointState& joints;
    const DeformableState& deformables;
    TaskPool& workers;
    StepReport& report;
    RigidState& rigid;
    ContactState& contacts;
    ActivityState& activity;
    EventState& events;
};

/// Filling of a vessel: a new fluid has particles only outside obstacles.
struct ObstacleAccess {
    explicit ObstacleAccess(WorldState& world);
    const WorldSettings& settings;
    const RigidState& rigid;
    const ContactState& contacts;
    TaskPool& workers;
};

struct FluidAccess : WakeAccess {
    explicit FluidAccess(WorldState& world);
    FluidState& fluids;
    DeformableState& immersed;  ///< the deformables: forces on their nodes and their sleep
};

/// The broad phase.
struct PairsAccess {
    explicit PairsAccess(WorldState& world);
    const WorldSettings& settings;
    const RigidState& rigid;
    const ActivityState& activity;
    TaskPool& workers;
    StepReport& report;
    ContactState& contacts;
};

/// The narrow phase.
using TouchAccess = WakeAccess;

/// Balls that roll on still ground.
struct RollAccess {
    explicit RollAccess(WorldState& world);
    const WorldSettings& settings;
    const RigidState& rigid;
    const JointState& joints;
    const ActivityState& activity;
    TaskPool& workers;
    StepReport& report;
    Ledger* ledger;
    ContactState& contacts;
    BallMemory& balls;
};

struct ImpactAccess {
    explicit ImpactAccess(WorldState& world);
    const WorldSettings& settings;
    const ActivityState& activity;
    TaskPool& workers;
    StepReport& report;
    Ledger* ledger;
    RigidState& rigid;
    JointState& joints;
    ContactState& contacts;
    ImpactMemory& impacts;
};

struct IslandAccess {
    explicit IslandAccess(WorldState& world);
    const WorldSettings& settings;
    const RigidState& rigid;
    StepReport& report;
    JointState& joints;
    ContactState& contacts;
    ActivityState& activity;
    ImpactMemory& impacts;
    Islands& islands;
};

struct SubstepAccess {
    explicit SubstepAccess(WorldState& world);
    const WorldSettings& settings;
    const Islands& islands;
    const BallMemory& balls;
    TaskPool& workers;
    StepReport& report;
    Ledger* ledger;
    RigidState& rigid;
    JointState& joints;
    ContactState& contacts;
    ActivityState& activity;
    ImpactMemory& impacts;
    SubstepMemory& substeps;
};

/// Continuous collision.
struct ContinuousAccess {
    explicit ContinuousAccess(WorldState& world);
    const WorldSettings& settings;
    const JointState& joints;
    const ActivityState& activity;
    const BallMemory& balls;
    TaskPool& workers;
    RigidState& rigid;
    ContactState& contacts;
};

struct DeformableAccess {
    explicit DeformableAccess(WorldState& world);
    const WorldSettings& settings;
    const ContactState& contacts;
    const JointState& joints;
    TaskPool& workers;
    StepReport& report;
    RigidState& rigid;
    ActivityState& activity;
    DeformableState& deformables;
    EventState& events;
};

struct SleepAccess {
    explicit SleepAccess(WorldState& world);
    const WorldSettings& settings;
    const Islands& islands;
    TaskPool& workers;
    RigidState& rigid;
    ContactState& contacts;
    ActivityState& activity;
    EventState& events;
};

/// Brittle bodies that blows break.
struct FractureAccess {
    explicit FractureAccess(WorldState& world);
    const JointState& joints;
    const ContactState& contacts;
    const ActivityState& activity;
    const StepReport& report;
    RigidState& rigid;
    FractureState& fracture;
};

/// The report of a step once it is over.
struct ReportAccess {
    explicit ReportAccess(WorldState& world);
    const ContactState& contacts;
    const ActivityState& activity;
    TaskPool& workers;
    StepReport& report;
    RigidState& rigid;
    EventState& events;
};

}  // namespace embody::physics::stages
