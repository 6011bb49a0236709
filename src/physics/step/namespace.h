// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace stages {}
namespace state {}
}  // namespace embody::physics

/// The order of the stages, and the report of a step. Only the face calls it.
namespace embody::physics::step {

// The rooms that it may see (docs/architecture.md).
using namespace stages;
using namespace state;

}  // namespace embody::physics::step
