// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace embody::catalog {

/// Half of the memory that this process may use at all, bytes: the machine's, or its control group's where that is
/// less.
std::size_t default_memory_budget();

/// How the workers of one import divide its memory: several at a time for most models, one at a time, with all of it,
/// for those that need more.
struct WorkerMemory {
    std::size_t workers = 1;  ///< at a time
    std::size_t each = 0;     ///< address space of each of them, bytes
    std::size_t alone = 0;    ///< address space of one that works alone, bytes
};

/// `budget`: bytes for all; `wanted`: workers, at least 1. Fewer workers where each would have too little to read
/// ordinary models.
WorkerMemory divide_memory(std::size_t budget, std::size_t wanted);

}  // namespace embody::catalog
