// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/task_pool.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"

namespace embody::physics::stages {

/// Calls work(worker, share) for shares of the awake bodies, on all workers where there are many. What comes of it must
/// not depend on who does what.
template <class Access, class Work>
void share_awake(const Access& world, Work work) {
    constexpr std::size_t fewest_shared = 500;
    const std::size_t count = world.activity.awake.size();
    share_among(world.workers, count, count >= fewest_shared, work);
}

/// The same for each awake body: work(body).
template <class Access, class Work>
void for_each_awake(const Access& world, Work work) {
    share_awake(world, [&](int, Share share) {
        for (std::size_t i = share.first; i < share.last; ++i) work(world.activity.awake[i]);
    });
}

}  // namespace embody::physics::stages
