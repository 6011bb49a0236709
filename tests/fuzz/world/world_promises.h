// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/inter/world.h"

namespace embody::fuzz {

/// Hash of everything that a refused call must leave unchanged.
std::uint64_t fingerprint(const physics::World& world);

/// Checks what holds after every step: the state's own invariants (state::validate), and results of the interface that
/// are finite and agree with each other. Ends the process where one does not hold.
void require_sound(const physics::World& world);

}  // namespace embody::fuzz
