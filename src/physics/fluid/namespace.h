// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace collision {}
namespace linear {}
}  // namespace embody::physics

/// Liquids on a grid with particles: pressure, viscosity, surface tension, and bodies as their obstacles.
namespace embody::physics::fluid {

// Namespaces that it may use (docs/architecture.md).
using namespace collision;
using namespace linear;

}  // namespace embody::physics::fluid
