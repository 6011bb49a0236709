// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/inter/world.h"

namespace embody::fuzz {

/// Bits of all that a refused call must leave as it was.
std::uint64_t fingerprint(const physics::World& world);

/// What holds after every step: the state's own invariants (state::validate), finite numbers in all that the face
/// tells, and what it tells agrees. Ends the process where it does not.
void require_sound(const physics::World& world);

}  // namespace embody::fuzz
