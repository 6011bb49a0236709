// SPDX-License-Identifier: MIT
#pragma once

namespace embody::physics {
namespace constraint {}
namespace dynamic {}
}  // namespace embody::physics

/// The paper's Optimization module: contact graph, islands, sleeping, shock propagation, order and choice of solver.
/// It computes no impulse.
namespace embody::physics::optimization {

// The rooms that it may see (docs/architecture.md).
using namespace constraint;
using namespace dynamic;

}  // namespace embody::physics::optimization
