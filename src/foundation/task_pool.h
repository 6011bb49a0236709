// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace embody {

/// Lets the workers of one task wait for each other, again and again. Spins first: stages are microseconds apart.
class alignas(64) Barrier {  // on a cache line of its own: workers read what lies beside it
public:
    explicit Barrier(int workers) : workers_(workers) {}
    /// Returns when all workers have called it.
    void wait();

private:
    const int workers_;
    std::atomic<int> arrived_{0};
    std::atomic<unsigned> round_{0};
};

/// The progress of one worker of a task, for others that follow it. Spins first.
class alignas(64) Progress {
public:
    void reach(std::uint64_t count) { count_.store(count, std::memory_order_release); }
    /// Returns when the progress has reached `count`.
    void wait_for(std::uint64_t count) const;

private:
    std::atomic<std::uint64_t> count_{0};
};

/// A fixed set of threads that run one task together. The calling thread is worker 0, so a pool of one has no threads;
/// the others start with the first task. Between tasks they sleep, after polling for the next one for a short
/// while.
class TaskPool {
public:
    /// `workers` >= 1.
    explicit TaskPool(int workers);
    ~TaskPool();
    /// The number of workers that is worth its cost on this machine: half of the threads that it can run at once, since
    /// two threads of one core gain little, but two where it can; four at most.
    static int workers_that_pay();

    TaskPool(const TaskPool&) = delete;
    TaskPool& operator=(const TaskPool&) = delete;

    [[nodiscard]] int workers() const;
    /// Calls task(worker) once on each worker, 0 … workers() - 1, and returns when all have returned. `task` must not
    /// throw. One caller at a time.
    void run(const std::function<void(int worker)>& task);

    /// While one exists the pool's threads stay awake between tasks that come within about a millisecond. To wake a
    /// thread takes 30 to 80 microseconds, so create it some time before the first of a row of tasks.
    class StayAwake {
    public:
        explicit StayAwake(TaskPool& pool);
        ~StayAwake();
        StayAwake(const StayAwake&) = delete;
        StayAwake& operator=(const StayAwake&) = delete;

    private:
        TaskPool& pool_;
    };

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The part of `count` indices for worker `worker`: the same for each call with the same numbers.
struct IndexRange {
    std::size_t first = 0, last = 0;
};
inline IndexRange range_of(std::size_t count, int worker, int workers) {
    const auto w = static_cast<std::size_t>(worker), n = static_cast<std::size_t>(workers);
    return {count * w / n, count * (w + 1) / n};
}

/// Calls work(worker, range) for ranges of `count` indices, on all workers if is_parallel; else work(0, all).
template <class Work>
void parallel_for(TaskPool& workers, std::size_t count, bool is_parallel, Work work) {
    const int number = workers.workers();
    if (!is_parallel || number == 1) return work(0, IndexRange{0, count});
    workers.run([&](int worker) { work(worker, range_of(count, worker, number)); });
}

}  // namespace embody
