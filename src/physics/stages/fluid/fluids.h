// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/fluid_record.h"

namespace embody::physics::stages {

/// Particles that fill the definition's volume and no obstacle. Fails where there are none or too many, or a hull is
/// flat.
Result<FluidRecord> set_up_fluid(const ObstacleAccess& world, const FluidDefinition& definition);
/// More particles for it, at rest, where no obstacle is. Fails where there are none or too many.
Result<FluidIds> add_particles(const ObstacleAccess& world, FluidRecord& fluid, std::span<const Vec3> places);
/// Particles exactly there, also where obstacles are.
FluidIds add_drops(FluidRecord& fluid, std::span<const FluidDrop> drops, TaskPool& workers);
/// Whether so many more particles, or ids, are allowed.
Result<void> check_room(const FluidRecord& fluid, std::size_t count);
/// A fluid of the same matter and particle size, without particles yet, around the places of these.
FluidRecord fluid_around(const FluidRecord& other, FluidIds ids);
/// Moves particles from one fluid to another, as they are; returns their ids there. Call read_particles for both
/// afterwards.
FluidIds move_particles(FluidRecord& from, FluidIds ids, FluidRecord& to);
/// Measures the obstacles around a new fluid, which the first step would have to do.
void prepare_fluid(const FluidAccess& world, FluidRecord& fluid);
/// Fills what is read of a fluid from its solver.
void read_particles(FluidRecord& record, TaskPool& workers);

}  // namespace embody::physics::stages
