// SPDX-License-Identifier: MIT
#include "physics/stages/access.h"

#include "physics/state/world_state.h"

namespace embody::physics::stages {

WakeAccess::WakeAccess(WorldState& world)
    : settings(world.settings),
      joints(world.joints),
      deformables(world.deformables),
      workers(*world.workers),
      report(world.report),
      rigid(world.rigid),
      contacts(world.contacts),
      activity(world.activity),
      events(world.events) {}

ObstacleAccess::ObstacleAccess(WorldState& world)
    : settings(world.settings), rigid(world.rigid), contacts(world.contacts), workers(*world.workers) {}

FluidAccess::FluidAccess(WorldState& world) : WakeAccess(world), fluids(world.fluids), immersed(world.deformables) {}

PairsAccess::PairsAccess(WorldState& world)
    : settings(world.settings),
      rigid(world.rigid),
      activity(world.activity),
      workers(*world.workers),
      report(world.report),
      contacts(world.contacts) {}

RollAccess::RollAccess(WorldState& world)
    : settings(world.settings),
      rigid(world.rigid),
      joints(world.joints),
      activity(world.activity),
      workers(*world.workers),
      report(world.report),
      ledger(world.ledger.get()),
      contacts(world.contacts),
      balls(world.balls) {}

ImpactAccess::ImpactAccess(WorldState& world)
    : settings(world.settings),
      activity(world.activity),
      workers(*world.workers),
      report(world.report),
      ledger(world.ledger.get()),
      rigid(world.rigid),
      joints(world.joints),
      contacts(world.contacts),
      impacts(world.impacts) {}

IslandAccess::IslandAccess(WorldState& world)
    : settings(world.settings),
      rigid(world.rigid),
      report(world.report),
      joints(world.joints),
      contacts(world.contacts),
      activity(world.activity),
      impacts(world.impacts),
      islands(world.islands) {}

SubstepAccess::SubstepAccess(WorldState& world)
    : settings(world.settings),
      islands(world.islands),
      balls(world.balls),
      workers(*world.workers),
      report(world.report),
      ledger(world.ledger.get()),
      rigid(world.rigid),
      joints(world.joints),
      contacts(world.contacts),
      activity(world.activity),
      impacts(world.impacts),
      substeps(world.substeps) {}

ContinuousAccess::ContinuousAccess(WorldState& world)
    : settings(world.settings),
      joints(world.joints),
      activity(world.activity),
      balls(world.balls),
      workers(*world.workers),
      rigid(world.rigid),
      contacts(world.contacts) {}

DeformableAccess::DeformableAccess(WorldState& world)
    : settings(world.settings),
      contacts(world.contacts),
      joints(world.joints),
      workers(*world.workers),
      report(world.report),
      rigid(world.rigid),
      activity(world.activity),
      deformables(world.deformables),
      events(world.events) {}

SleepAccess::SleepAccess(WorldState& world)
    : settings(world.settings),
      islands(world.islands),
      workers(*world.workers),
      rigid(world.rigid),
      contacts(world.contacts),
      activity(world.activity),
      events(world.events) {}

FractureAccess::FractureAccess(WorldState& world)
    : joints(world.joints),
      contacts(world.contacts),
      activity(world.activity),
      report(world.report),
      rigid(world.rigid),
      fracture(world.fracture) {}

ReportAccess::ReportAccess(WorldState& world)
    : contacts(world.contacts),
      activity(world.activity),
      workers(*world.workers),
      report(world.report),
      rigid(world.rigid),
      events(world.events) {}

}  // namespace embody::physics::stages
