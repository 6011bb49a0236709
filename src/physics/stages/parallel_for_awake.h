// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/task_pool.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"

namespace embody::physics::stages {

/// Calls work(worker, range) for ranges of the awake bodies, on all workers where there are many. The result must not
/// depend on which worker has which range.
template <class Access, class Work>
void parallel_for_awake(const Access& world, Work work) {
    constexpr std::size_t min_parallel_count = 500;  // bodies: below, waking the workers costs more
    const std::size_t count = world.activity.awake.size();
    parallel_for(world.workers, count, count >= min_parallel_count, work);
}

/// The same for each awake body: work(body).
template <class Access, class Work>
void for_each_awake(const Access& world, Work work) {
    parallel_for_awake(world, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) work(world.activity.awake[i]);
    });
}

}  // namespace embody::physics::stages
