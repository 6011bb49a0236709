// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/collision/broad_phase/broad_phase.h"
#include "physics/constraint/contact/contact.h"
#include "physics/state/namespace.h"
#include "physics/state/touch_memory.h"

namespace embody::physics::state {

/// A body that has left the bounds that the broad phase has for it.
struct LeavingBody {
    std::uint32_t body = 0;
    Bounds bounds;  ///< bounds of its path in this step
    Vec3 motion;    ///< m, in this step
};

/// Which bodies may touch, and which do touch.
struct ContactState {
    BroadPhase broad_phase;                                // find pairs
    std::vector<std::vector<LeavingBody>> leaving;         // find pairs: memory only, by worker
    const std::vector<BroadPhase::Pair>* pairs = nullptr;  // find pairs
    TouchMemory touch;                                     // touch
    std::vector<Contact> list;                             // touch; impulses: impact, substeps
    std::vector<ContactSummary> summaries;                 // touch, substeps, sleep: one for each contact
};

}  // namespace embody::physics::state
