// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace state {}
namespace optimization {}
namespace deformable {}
namespace fluid {}
namespace fracture {}
namespace constraint {}
namespace collision {}
namespace dynamic {}
}  // namespace embody::physics

/// What a step does to the world's state, stage by stage, in the order of stages.h. Only step and the face call them.
namespace embody::physics::stages {

// Namespaces that it may use (docs/architecture.md).
using namespace state;
using namespace optimization;
using namespace deformable;
using namespace fluid;
using namespace fracture;
using namespace constraint;
using namespace collision;
using namespace dynamic;

}  // namespace embody::physics::stages
