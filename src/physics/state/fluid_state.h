// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "foundation/handle_table.h"
#include "physics/state/fluid_record.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// The liquids and grains.
struct FluidState {
    HandleTable<struct FluidTag, FluidRecord> records;  // face; particles: fluids
    std::vector<FluidTouch> touches;                    // fluids: by slot of the body
    std::vector<std::uint32_t> pushed_bodies;           // fluids: slots whose fluid_force is not zero
};

}  // namespace embody::physics::state
