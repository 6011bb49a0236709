// SPDX-License-Identifier: MIT
#include "foundation/task_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

namespace embody {
namespace {

class EachPool : public ::testing::TestWithParam<int> {};

TEST_P(EachPool, RunsATaskOnceOnEachWorkerAgainAndAgain) {
    TaskPool pool(GetParam());
    ASSERT_EQ(pool.workers(), GetParam());
    std::vector<int> calls(static_cast<std::size_t>(GetParam()), 0);
    for (int iteration = 0; iteration < 2000; ++iteration)
        pool.run([&](int worker) { ++calls[static_cast<std::size_t>(worker)]; });
    for (const int count : calls) EXPECT_EQ(count, 2000);
}

TEST(TaskPool, TakesNoMoreWorkersThanTheMachineHasThreads) {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    EXPECT_GE(TaskPool::workers_that_pay(), std::min(threads, 2));
    EXPECT_LE(TaskPool::workers_that_pay(), std::min(threads, 4));
}

TEST_P(EachPool, RunsTasksAfterPausesWithThreadsAwakeOrAsleep) {
    // Tasks with longer pauses than the threads wait actively for the next one, so that they sleep and must be woken.
    TaskPool pool(GetParam());
    std::vector<int> calls(static_cast<std::size_t>(GetParam()), 0);
    const auto count = [&](int worker) { ++calls[static_cast<std::size_t>(worker)]; };
    for (int iteration = 0; iteration < 20; ++iteration) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        pool.run(count);
        const TaskPool::StayAwake stay_awake(pool);
        for (const int pause : {0, 2}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(pause));
            pool.run(count);
        }
    }
    for (const int each : calls) EXPECT_EQ(each, 60);
}

TEST_P(EachPool, StepsChooseHowManyWorkersRun) {
    // So many that other numbers are tried. Each task is run once by each worker of its step, and by no other.
    TaskPool pool(GetParam(), TaskPool::Use::as_many_as_pay);
    EXPECT_EQ(pool.max_workers(), GetParam());
    int fewest = GetParam();
    for (int iteration = 0; iteration < 3000; ++iteration) {
        const TaskPool::Step step(pool);
        const int workers = pool.workers();
        ASSERT_GE(workers, 1);
        ASSERT_LE(workers, GetParam());
        fewest = std::min(fewest, workers);
        std::vector<int> calls(static_cast<std::size_t>(GetParam()), 0);
        for (int task = 0; task < 3; ++task) pool.run([&](int worker) { ++calls[static_cast<std::size_t>(worker)]; });
        for (int worker = 0; worker < GetParam(); ++worker)
            ASSERT_EQ(calls[static_cast<std::size_t>(worker)], worker < workers ? 3 : 0);
    }
    if (GetParam() > 1) {
        EXPECT_LT(fewest, GetParam());
    }
}

TEST_P(EachPool, WithoutAChoiceAllWorkersRunInEachStep) {
    TaskPool pool(GetParam());
    for (int iteration = 0; iteration < 2000; ++iteration) {
        const TaskPool::Step step(pool);
        ASSERT_EQ(pool.workers(), GetParam());
        pool.run([](int) {});
    }
}

TEST_P(EachPool, WorkersMeetAtTheBarrier) {
    // Each worker adds to its neighbour's number in turns; without the barrier additions would be lost.
    const int workers = GetParam();
    TaskPool pool(workers);
    Barrier barrier(workers);
    std::vector<long> numbers(static_cast<std::size_t>(workers), 1);
    pool.run([&](int worker) {
        for (int iteration = 0; iteration < 500; ++iteration) {
            const auto target = static_cast<std::size_t>((worker + iteration) % workers);
            numbers[target] += iteration;
            barrier.wait();
        }
    });
    const long sum = std::accumulate(numbers.begin(), numbers.end(), 0L);
    EXPECT_EQ(sum, workers * (1 + 500L * 499 / 2));
}

TEST_P(EachPool, RangesOfTheWorkersCoverEachIndexOnce) {
    for (const std::size_t count : {0u, 1u, 7u, 64u, 1001u}) {
        std::size_t next = 0;
        for (int worker = 0; worker < GetParam(); ++worker) {
            const IndexRange range = range_of(count, worker, GetParam());
            EXPECT_EQ(range.first, next);
            next = range.last;
        }
        EXPECT_EQ(next, count);
    }
}

INSTANTIATE_TEST_SUITE_P(Workers, EachPool, ::testing::Values(1, 2, 3, 8));

}  // namespace
}  // namespace embody
