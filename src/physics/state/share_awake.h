// SPDX-License-Identifier: MIT
#pragma once

#include "physics/state/namespace.h"
#include "physics/state/world_state.h"

namespace embody::physics::state {

/// Calls work(worker, share) for shares of the awake bodies, on all workers where there are many. What comes of it must
/// not depend on who does what.
template <class Work>
void share_awake(WorldState& world, Work work) {
    constexpr std::size_t fewest_shared = 500;
    share_among(*world.workers, world.awake.size(), world.awake.size() >= fewest_shared, work);
}

/// The same for each awake body: work(body).
template <class Work>
void for_each_awake(WorldState& world, Work work) {
    share_awake(world, [&](int, Share share) {
        for (std::size_t i = share.first; i < share.last; ++i) work(world.awake[i]);
    });
}

}  // namespace embody::physics::state
