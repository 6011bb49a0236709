// SPDX-License-Identifier: MIT
#pragma once

#include "physics/optimization/islands.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// A point of the contacts.
struct DeepestPoint {
    std::uint32_t contact = 0;  ///< index
    std::size_t point = 0;
};

/// Moves an island of one body through the step if the body rolls on something flat that stands still, and turns far in
/// a step or its axis turns: coins that lean, cones on their side, tops on their tip, fast wheels. The contact solver
/// holds the place of contact fast for a step, and each step's new place would cost (Ω dt)² of the energy. False where
/// the island is left to the other solvers.
bool roll_alone(const SubstepAccess& world, const Island& island);

/// Puts all of the ground's impulse (N s, on the contact's b) at that point of an island's contacts (indices in the
/// list), scaled as those of the sweeps.
void note_load(const WorldSettings& settings, std::span<const std::uint32_t> contacts, const DeepestPoint& deepest,
               Vec3 impulse, std::vector<Contact>& list);

}  // namespace embody::physics::stages
