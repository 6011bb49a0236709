// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace collision {}
namespace linear {}
namespace dynamic {}
}  // namespace embody::physics

/// The paper's Constraint module: contacts (eq. 4 to 7) solved by sweeps or directly, joints, micro-collisions (eq. 3)
/// and rolling. Solves the lists it is given and knows nothing of islands.
namespace embody::physics::constraint {

// Namespaces that it may use (docs/architecture.md).
using namespace collision;
using namespace linear;
using namespace dynamic;

}  // namespace embody::physics::constraint
