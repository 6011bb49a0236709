// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "foundation/handle_table.h"
#include "physics/definitions/fluid_port.h"
#include "physics/state/fluid_record.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// A source or a drain, and what went through it.
struct FluidPortRecord {
    FluidPort port;
    double owed = 0;           ///< m³ that a source has not yet made particles of
    std::uint64_t index = 0;   ///< of a source's next particle, for its place in the disc
    std::uint64_t passed = 0;  ///< particles
    bool waits = false;        ///< since the last step: its fluid has as many particles as the source allows
};

/// The liquids and grains.
struct FluidState {
    HandleTable<struct FluidTag, FluidRecord> records;        // face; particles: fluids
    HandleTable<struct FluidPortTag, FluidPortRecord> ports;  // face; counts: fluids
    std::vector<FluidTouch> touches;                          // fluids: by slot of the body
    std::vector<std::uint32_t> pushed_bodies;                 // fluids: slots whose fluid_force is not zero
};

}  // namespace embody::physics::state
