// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::catalog {

struct ConfinementOptions {
    std::size_t address_space = std::size_t{3} << 30;  ///< bytes
    unsigned processor_seconds = 3600;                 ///< over the whole life of the worker
    long parent = 0;                                   ///< process that must be alive, or this one dies
    /// Files, and folders with all below, that may still be read; none: all that the user may read.
    std::vector<std::string> readable = {};
};

/// Gives up, for good, all rights that reading models does not need. What is left: reading these files (where the
/// kernel has Landlock, as Linux does since 5.13; else all files), memory up to the limit, and the open pipes 0, 1 and
/// 2. What goes: network, new processes and programs, writing, creating or removing files, signals to others,
/// executable memory; see docs/import.md. The process ends with its parent. Call before the first byte of a foreign
/// file is read. Linux only.
Result<void> confine_this_process(const ConfinementOptions& options);

}  // namespace embody::catalog
