// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace optimization {}
namespace deformable {}
namespace fluid {}
namespace constraint {}
namespace collision {}
namespace dynamic {}
}  // namespace embody::physics

/// The state of a world between steps, and the memory of its stages. Only stages, step and the face may include it.
namespace embody::physics::state {

// The rooms that it may see (docs/architecture.md).
using namespace optimization;
using namespace deformable;
using namespace fluid;
using namespace constraint;
using namespace collision;
using namespace dynamic;

}  // namespace embody::physics::state
