// SPDX-License-Identifier: MIT
#include "foundation/task_pool.h"

#include <algorithm>
#include <string>
#include <thread>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "foundation/assert.h"
#include "foundation/zone.h"

namespace embody {

namespace {

// A waiting thread polls this often, some 20 microseconds, before it yields its core with each further poll: the thread
// that it waits for may need that core where other programs run.
constexpr int looks_alone = 1000;
// The total number of polls before it sleeps: some 100 microseconds between tasks, a millisecond between tasks of a
// row, if nobody takes the core.
constexpr int looks_between_tasks = looks_alone + 200, looks_while_awake = looks_alone + 2000;

void wait_a_little(int look) {
    if (look >= looks_alone) return std::this_thread::yield();
#if defined(__x86_64__)
    _mm_pause();
#endif
}

}  // namespace

void Barrier::wait() {
    if (workers_ == 1) return;
    const unsigned round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == workers_) {
        arrived_.store(0, std::memory_order_relaxed);
        round_.store(round + 1, std::memory_order_release);
        return;
    }
    for (int i = 0; round_.load(std::memory_order_acquire) == round; ++i) wait_a_little(i);
}

void Progress::wait_for(std::uint64_t count) const {
    for (int i = 0; count_.load(std::memory_order_acquire) < count; ++i) wait_a_little(i);
}

struct TaskPool::State {
    const std::function<void(int)>* task = nullptr;  // of the present call of run()
    const char* zone = nullptr;                      // zone in which the task is run
    std::atomic<unsigned> round{0};
    std::atomic<unsigned> calls{0};  // increases with each run() and each StayAwake: sleeping threads wait on it
    std::atomic<int> looks{looks_between_tasks};
    std::atomic<int> running{0};
    std::atomic<bool> stops{false};
    int workers = 1;
    std::vector<std::thread> threads;

    void start() {
        for (int worker = static_cast<int>(threads.size()) + 1; worker < workers; ++worker) {
            threads.emplace_back([this, worker] {
                name_zone_thread("worker " + std::to_string(worker));
                work(worker);
            });
        }
    }

    // Wakes the threads that sleep.
    void call() {
        ++calls;  // in one order with the waiting, so that none is missed
        calls.notify_all();
    }

    // Returns when the present call is another one than `seen`: polls for a while, then sleeps until called, and
    // repeats.
    void await_round(unsigned seen) {
        while (true) {
            const unsigned call = calls.load(std::memory_order_acquire);
            for (int i = 0; i < looks.load(std::memory_order_relaxed); ++i) {
                if (round.load(std::memory_order_acquire) != seen) return;
                wait_a_little(i);
            }
            if (round.load(std::memory_order_acquire) != seen) return;
            calls.wait(call, std::memory_order_acquire);
        }
    }

    void work(int worker) {
        unsigned seen = 0;
        while (true) {
            await_round(seen);
            seen = round.load(std::memory_order_acquire);
            if (stops.load(std::memory_order_relaxed)) return;
            {
                const Zone of_task(zone);
                (*task)(worker);
            }
            running.fetch_sub(1, std::memory_order_acq_rel);
        }
    }
};

TaskPool::StayAwake::StayAwake(TaskPool& pool) : pool_(pool) {
    pool_.state_->start();
    pool_.state_->looks.store(looks_while_awake, std::memory_order_relaxed);
    pool_.state_->call();
}

TaskPool::StayAwake::~StayAwake() { pool_.state_->looks.store(looks_between_tasks, std::memory_order_relaxed); }

TaskPool::TaskPool(int workers) : state_(std::make_unique<State>()) {
    EMBODY_ASSERT(workers >= 1);
    state_->workers = workers;
}

TaskPool::~TaskPool() {
    state_->stops.store(true, std::memory_order_relaxed);
    state_->round.fetch_add(1, std::memory_order_release);
    state_->call();
    for (std::thread& thread : state_->threads) thread.join();
}

int TaskPool::workers_that_pay() {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return std::clamp(threads / 2, std::min(threads, 2), 4);
}

int TaskPool::workers() const { return state_->workers; }

void TaskPool::run(const std::function<void(int)>& task) {
    State& s = *state_;
    if (s.workers == 1) return task(0);
    s.start();
    s.task = &task;
    s.zone = innermost_zone();
    s.running.store(static_cast<int>(s.threads.size()), std::memory_order_relaxed);
    s.round.fetch_add(1, std::memory_order_release);
    s.call();
    task(0);
    for (int i = 0; s.running.load(std::memory_order_acquire) > 0; ++i) wait_a_little(i);
}

}  // namespace embody
