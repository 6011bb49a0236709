// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

struct ConfinedPoolOptions {
    int workers = 0;                          ///< processes at most; 0: one a core
    double processor_seconds_per_model = 60;  ///< more: the worker is killed, the model reported; at most 1800
    double wall_seconds_per_model = 900;      ///< the same, for workers that wait instead of working
    std::size_t bytes = 0;                    ///< address space of all workers together; 0: half of the memory
    std::filesystem::path worker_program;     ///< empty: embody-import-worker beside the running program
    bool in_background = false;               ///< workers leave the processor to others that want it
    std::function<bool()> go_on = {};         ///< called about once a second; false stops; may be empty
};

/// Prepares `items` in worker processes of their own (limits on memory, time and system calls; no network), so that a
/// crash, a hang or a memory bomb of one file costs that file only. Items that a crowded machine may have failed (a
/// worker that died, or exceeded its part of the memory or of wall time) are tried once more at the end, one after the
/// other, each by a new worker with all of the memory. `done` is called on the calling thread, once an item, in the
/// order in which they finish; it returns false to stop early. Fails only if no worker can be started.
Result<void> prepare_confined(const std::vector<ImportItem>& items, const ConfinedPoolOptions& options,
                              const std::function<bool(std::size_t item, Result<PreparedModel> prepared)>& done);

}  // namespace embody::catalog
