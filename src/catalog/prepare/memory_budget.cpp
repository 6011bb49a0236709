// SPDX-License-Identifier: MIT
// Control groups: Linux, Documentation/admin-guide/cgroup-v2.rst, "memory.max".
#include "catalog/prepare/memory_budget.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace embody::catalog {
namespace {

// A worker's libraries take 0.3 GiB of address space; the largest of 7,500 real models took 0.12 GiB beside them.
constexpr std::size_t min_worker_bytes = std::size_t{1} << 30;
constexpr std::size_t max_worker_bytes = std::size_t{3} << 30;

/// The smallest memory.max of this process's control group and those above it; all memory where none is set.
std::size_t control_group_limit() {
    std::size_t min_limit = std::numeric_limits<std::size_t>::max();
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        if (!line.starts_with("0::/")) continue;
        for (std::filesystem::path group = line.substr(3);; group = group.parent_path()) {
            std::size_t limit = 0;  // the file may say "max", which is no number
            if (std::ifstream("/sys/fs/cgroup" + group.string() + "/memory.max") >> limit)
                min_limit = std::min(min_limit, limit);
            if (!group.has_relative_path()) break;
        }
    }
    return min_limit;
}

}  // namespace

std::size_t default_memory_budget() {
    const std::size_t pages = static_cast<std::size_t>(std::max(1l, sysconf(_SC_PHYS_PAGES)));
    const std::size_t page = static_cast<std::size_t>(std::max(1l, sysconf(_SC_PAGESIZE)));
    return std::min(pages * page, control_group_limit()) / 2;
}

WorkerMemory divide_memory(std::size_t budget, std::size_t wanted) {
    const std::size_t workers = std::clamp<std::size_t>(budget / min_worker_bytes, 1, std::max<std::size_t>(1, wanted));
    return {workers, std::min(budget / workers, max_worker_bytes), budget};
}

}  // namespace embody::catalog
