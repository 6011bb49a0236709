// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec3.h"

namespace embody::physics {

namespace state {
struct WorldState;
}

/// What touches, as numbers of DebugMeaning::contact.
enum class TouchKind : std::uint16_t { bodies, deformable, fluid };

/// A place where two things touch, whatever they are.
struct DrawnContact {
    Vec3 position;  ///< world, m
    Vec3 normal;    ///< towards what the impulse is on
    Vec3 impulse;   ///< of the last step, world, N s; of a deformable by its force at the step's end
    TouchKind kind = TouchKind::bodies;
};

/// Appends the contacts of soft solids, sheets and ropes with bodies, each other and themselves; the normal is towards
/// the deformable, of two that towards the one whose force it is.
void add_contacts_of_deformables(const state::WorldState& world, std::vector<DrawnContact>& contacts);

/// Appends the particles of liquids that lie next to a body, with the body's normal and without an impulse: the solver
/// knows pressures on its grid, not what a particle pushes.
void add_contacts_of_particles(const state::WorldState& world, std::vector<DrawnContact>& contacts);

/// What all liquids push a body in the last step.
struct FluidPush {
    Vec3 center;   ///< of the body's mass, world, m
    Vec3 impulse;  ///< N s
};
std::vector<FluidPush> pushes_of_fluids(const state::WorldState& world);

}  // namespace embody::physics
