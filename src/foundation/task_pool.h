// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace embody {

/// Lets the workers of one task wait for each other, again and again. Spins first, as stages are microseconds apart,
/// and sleeps where another thread takes the core.
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

/// The progress of one worker of a task, for others that follow it. They wait as at a Barrier.
class alignas(64) Progress {
public:
    void reach(std::uint64_t count);
    /// Returns when the progress has reached `count`.
    void wait_for(std::uint64_t count) const;

private:
    std::atomic<std::uint64_t> count_{0};
};

/// A set of threads that run one task together. The calling thread is worker 0, so a pool of one has no threads;
/// the others start with the first task. Between tasks they sleep, after polling for the next one for a short
/// while.
class TaskPool {
public:
    /// Whether all workers run each task, or as many as pay while other programs use the cores (WorkerChoice).
    enum class Use : std::uint8_t { all, as_many_as_pay };

    /// `workers` >= 1, 255 at most.
    explicit TaskPool(int workers, Use use = Use::all);
    ~TaskPool();
    /// The number of workers that is worth its cost on this machine: half of the threads that it can run at once, since
    /// two threads of one core gain little, but two where it can; four at most.
    static int workers_that_pay();

    TaskPool(const TaskPool&) = delete;
    TaskPool& operator=(const TaskPool&) = delete;

    /// Workers of the next task: all, or what the present Step chose.
    [[nodiscard]] int workers() const;
    [[nodiscard]] int max_workers() const;
    [[nodiscard]] Use use() const;
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

    /// One of many similar pieces of work, of any number of tasks: from its end on the pool knows how long it took, and
    /// with Use::as_many_as_pay chooses by that how many workers the next one has. One at a time, by the calling
    /// thread.
    class Step {
    public:
        explicit Step(TaskPool& pool);
        ~Step();
        Step(const Step&) = delete;
        Step& operator=(const Step&) = delete;

    private:
        TaskPool& pool_;
        double begin_ = 0, ready_begin_ = 0,
               core_begin_ = 0;  // s; of all its workers together: ready to run, on a core
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
