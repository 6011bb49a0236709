// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"
#include "physics/state/substep_memory.h"

namespace embody::physics::stages {

/// A body's data from its definition: checked and computed before anything in the world changes.
struct BodySetup {
    BodyRecord record;
    BodyConstants constants;
    BodyState state;
    SleepRecord sleep;
};

/// Fails where the definition is out of range, the shape handle is stale, a movable body has a static-only shape, or
/// the mass is unknown.
Result<BodySetup> set_up_body(const RigidState& rigid, const BodyDefinition& definition);

/// Puts a set-up body into the slot's arrays and the broad phase.
void place_body(const WakeAccess& world, ImpactMemory& impacts, std::uint32_t body, BodySetup setup);

/// Takes them (each once) out of the broad phase, their sleeping groups and the contact lists; wakes what touched them.
void lift_bodies(const WakeAccess& world, std::span<const std::uint32_t> bodies);

/// The width of the contact solver; 0: the widest. Fails where the processor cannot.
Result<void> choose_lanes(SubstepMemory& substeps, int lanes);

/// Initial constraint of a joint record.
Result<Joint> set_up_joint(const RigidState& rigid, const JointDefinition& definition);

/// Rebuilds the list of pairs that joints keep from colliding.
void list_jointed_pairs(JointState& joints);
/// Adds the pair of a new joint.
void add_jointed_pair(JointState& joints, const JointDefinition& joint);

/// The definition as it stands now.
BodyDefinition current_definition(const RigidState& rigid, const ActivityState& activity, std::uint32_t body);

}  // namespace embody::physics::stages
