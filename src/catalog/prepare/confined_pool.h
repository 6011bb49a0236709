// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "catalog/prepare/prepared_model.h"

namespace embody::catalog {

struct ConfinedPoolOptions {
    int workers = 0;                                      ///< processes; 0: one a core
    double seconds_per_model = 60;                        ///< longer: the worker is killed, the model reported
    std::size_t bytes_per_worker = std::size_t{3} << 30;  ///< address space; more: the same
    std::filesystem::path worker_program;                 ///< empty: embody-import-worker beside the running program
};

/// Prepares `items` in worker processes of their own (limits on memory, time and system calls; no network), so that a
/// crash, a hang or a memory bomb of one file costs that file only. `done` is called on the calling thread, once an
/// item, in the order in which they finish; it returns false to stop early. Fails only if no worker can be started.
Result<void> prepare_confined(const std::vector<ImportItem>& items, const ConfinedPoolOptions& options,
                              const std::function<bool(std::size_t item, Result<PreparedModel> prepared)>& done);

}  // namespace embody::catalog
