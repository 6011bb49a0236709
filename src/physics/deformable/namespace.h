// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace collision {}
namespace linear {}
namespace dynamic {}
}  // namespace embody::physics

/// Soft solids, cloth and ropes: elements, implicit steps, and their contacts with bodies and each other.
namespace embody::physics::deformable {

// Namespaces that it may use (docs/architecture.md).
using namespace collision;
using namespace linear;
using namespace dynamic;

}  // namespace embody::physics::deformable
