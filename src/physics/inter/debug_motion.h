// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "physics/definitions/events.h"
#include "physics/inter/debug_canvas.h"

namespace embody::physics {

namespace state {
struct WorldState;
}

/// Arrows from the centres of mass of bodies that move.
void draw_velocities(const state::WorldState& world, DebugCanvas& canvas);

/// Weights and constant forces at centres of mass, and at contacts the mean force over the last step: all in one
/// proportion.
void draw_forces(const state::WorldState& world, std::span<const ContactView> contacts, DebugCanvas& canvas);

}  // namespace embody::physics
