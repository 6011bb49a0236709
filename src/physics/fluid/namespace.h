// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace collision {}
namespace linear {}
}  // namespace embody::physics

/// Liquids on a grid with particles: pressure, viscosity, surface tension, and the obstacles that bodies are to them.
namespace embody::physics::fluid {

// The rooms that it may see (docs/architecture.md).
using namespace collision;
using namespace linear;

}  // namespace embody::physics::fluid
