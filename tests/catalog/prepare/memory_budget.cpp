// SPDX-License-Identifier: MIT
#include "catalog/prepare/memory_budget.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace embody::catalog {
namespace {

constexpr std::size_t gibibyte = std::size_t{1} << 30;

TEST(MemoryBudget, IsAtMostHalfOfTheMachine) {
    const auto memory =
        static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    EXPECT_GT(default_memory_budget(), 0u);
    EXPECT_LE(default_memory_budget(), memory / 2);
}

TEST(MemoryBudget, AllWorkersTogetherStayWithinIt) {
    for (const std::size_t budget : {gibibyte / 4, gibibyte, 3 * gibibyte, 8 * gibibyte, 100 * gibibyte}) {
        for (const std::size_t wanted : {0, 1, 2, 7, 64}) {
            const WorkerMemory memory = divide_memory(budget, wanted);
            EXPECT_GE(memory.workers, 1u);
            EXPECT_LE(memory.workers, std::max<std::size_t>(1, wanted));
            EXPECT_LE(memory.workers * memory.each, budget);
            EXPECT_EQ(memory.alone, budget);
            EXPECT_TRUE(memory.each >= gibibyte || memory.workers == 1) << budget << " for " << wanted;
        }
    }
    // 64 cores with 8 GiB: eight workers of 1 GiB.
    EXPECT_EQ(divide_memory(8 * gibibyte, 64).workers, 8u);
    EXPECT_EQ(divide_memory(100 * gibibyte, 2).each, 3 * gibibyte);
}

}  // namespace
}  // namespace embody::catalog
