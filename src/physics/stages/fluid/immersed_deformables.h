// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/fluid/obstacles/immersed_points.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/fluid_record.h"

namespace embody::physics::stages {

/// What bends, near a fluid, by points that are immersed in it (docs/physics/coupling.md, "Liquids and what bends").
struct ImmersedDeformables {
    struct Part {
        std::uint32_t slot = 0;
        std::size_t first = 0, last = 0;  ///< of its points
    };
    std::vector<Part> parts;
    std::vector<ImmersedPoint> points;
    std::vector<ImmersedPlace> places;  ///< by point
};

/// Slots of the enabled deformables that the fluid may meet in this step, ascending.
std::vector<std::uint32_t> deformables_near(const FluidAccess& world, const FluidRecord& fluid);
/// Whether any of them moves, or one has come or gone, since a fluid fell asleep.
bool have_deformables_changed(const FluidAccess& world, const FluidRecord& fluid,
                              const std::vector<std::uint32_t>& slots);
/// Their points, with what is expected of elastic forces and contacts in this step.
ImmersedDeformables immerse(const FluidAccess& world, const FluidRecord& fluid,
                            const std::vector<std::uint32_t>& slots);
/// The forces of a fluid on the nodes in this step: SeenDeformable of the fluid.
void note_forces(const FluidAccess& world, FluidRecord& fluid, const ImmersedDeformables& immersed);
/// While the fluid is not quiet, nothing that it touches sleeps.
void keep_immersed_awake(const FluidAccess& world, const FluidRecord& fluid);
/// Whether all that the fluid touches sleeps.
bool are_immersed_asleep(const FluidAccess& world, const FluidRecord& fluid);

/// Before the fluids of a step: what each deformable's elastic forces and contacts did in the last one; then takes the
/// liquids' forces off the nodes.
void begin_immersed(const FluidAccess& world);
/// Adds a fluid's forces to the nodes.
void push_immersed(const FluidAccess& world, const FluidRecord& fluid);
/// After the deformables: gives a fluid the impulses that the nodes have had of it beyond those forces.
void settle_immersed(const FluidAccess& world, FluidRecord& fluid);
/// After all fluids: wakes what a fluid has woken, and remembers the forces.
void end_immersed(const FluidAccess& world);

}  // namespace embody::physics::stages
