// SPDX-License-Identifier: MIT
#include "foundation/task_pool.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#if defined(__linux__)
#include <pthread.h>
#include <time.h>
#endif

#include "foundation/assert.h"
#include "foundation/worker_choice.h"
#include "foundation/zone.h"

namespace embody {

namespace {

// A waiting thread polls this often, some 20 microseconds, before it yields its core with each further poll: the thread
// that it waits for may need that core where other programs run.
constexpr int looks_alone = 1000;
// The total number of polls before it sleeps: some 100 microseconds between tasks, a millisecond between tasks of a
// row and within a task, if nobody takes the core.
constexpr int looks_between_tasks = looks_alone + 200, looks_while_awake = looks_alone + 2000;
// A yield that takes longer, s, has given the core to another thread; one that nobody takes is over in a microsecond.
constexpr double core_taken = 50e-6;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Between two polls. False where another thread took the core: then it is better to sleep, since who is woken comes
// before a thread that runs on and on, and who yields comes after it, some milliseconds later each time.
bool wait_a_little(int look) {
    if (look < looks_alone) {
#if defined(__x86_64__)
        _mm_pause();
#endif
        return true;
    }
    const double before = seconds_now();
    std::this_thread::yield();
    return seconds_now() - before < core_taken;
}

// Returns when `is_done` of the number: polls, then sleeps until its next change is notified, and repeats. Who changes
// it does so in one order with all else (memory_order_seq_cst) and notifies then.
template <class Number, class Done>
void await(const std::atomic<Number>& number, Done is_done) {
    while (true) {
        bool has_core = true;
        for (int i = 0; has_core && i < looks_while_awake; ++i) {
            if (is_done(number.load(std::memory_order_acquire))) return;
            has_core = wait_a_little(i);
        }
        const Number seen = number.load(std::memory_order_acquire);
        if (is_done(seen)) return;
        number.wait(seen, std::memory_order_acquire);
    }
}

// The lowest byte of a round.
constexpr int max_byte = 255;

// How long a thread has been on a core so far, s; -1 where the system does not tell.
#if defined(__linux__)
double core_seconds(pthread_t thread) {
    clockid_t clock;
    timespec time;
    if (pthread_getcpuclockid(thread, &clock) != 0 || clock_gettime(clock, &time) != 0) return -1;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double core_seconds_here() { return core_seconds(pthread_self()); }
#else
double core_seconds(std::thread::native_handle_type) { return -1; }
double core_seconds_here() { return -1; }
#endif

}  // namespace

void Barrier::wait() {
    if (workers_ == 1) return;
    const unsigned round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == workers_) {
        arrived_.store(0, std::memory_order_relaxed);
        round_.store(round + 1, std::memory_order_seq_cst);
        round_.notify_all();
        return;
    }
    await(round_, [&](unsigned now) { return now != round; });
}

void Progress::reach(std::uint64_t count) {
    count_.store(count, std::memory_order_seq_cst);
    count_.notify_all();
}

void Progress::wait_for(std::uint64_t count) const {
    await(count_, [&](std::uint64_t now) { return now >= count; });
}

// A thread of a pool other than the calling one. On cache lines of its own, as each polls its own.
struct alignas(64) PoolThread {
    std::atomic<unsigned> calls{0};  // increases with each task and each StayAwake: the thread sleeps on it
    // How long it had slept when it was last woken, and since when it sleeps now, s; 0: it does not.
    std::atomic<double> slept{0}, asleep_since{0};
    std::thread thread;

    void call() {
        ++calls;  // in one order with the waiting, so that none is missed
        calls.notify_one();
    }

    void sleep(unsigned call) {
        const double begin = seconds_now();
        asleep_since.store(begin, std::memory_order_relaxed);
        calls.wait(call, std::memory_order_acquire);
        slept.store(slept.load(std::memory_order_relaxed) + seconds_now() - begin, std::memory_order_relaxed);
        asleep_since.store(0, std::memory_order_relaxed);
    }

    // How long it has slept until `now`, s.
    double slept_until(double now) const {
        const double since = asleep_since.load(std::memory_order_relaxed);
        return slept.load(std::memory_order_relaxed) + (since > 0 ? std::max(0.0, now - since) : 0);
    }
};

struct TaskPool::State {
    const std::function<void(int)>* task = nullptr;  // of the present call of run()
    const char* zone = nullptr;                      // zone in which the task is run
    // Count of the calls of run(), and the workers of the present one in the lowest byte: a thread that it leaves out
    // reads both at once.
    std::atomic<std::uint64_t> round{0};
    std::atomic<int> looks{looks_between_tasks};
    std::atomic<int> running{0};
    std::atomic<bool> stops{false};
    int workers = 1, max_workers = 1;
    std::optional<WorkerChoice> choice;                // where not all are always used
    std::vector<std::unique_ptr<PoolThread>> threads;  // of workers 1, 2, …

    void start() {
        for (int worker = static_cast<int>(threads.size()) + 1; worker < max_workers; ++worker) {
            threads.push_back(std::make_unique<PoolThread>());
            PoolThread& made = *threads.back();
            made.thread = std::thread([this, worker, &made] {
                name_zone_thread("worker " + std::to_string(worker));
                work(worker, made);
            });
        }
    }

    // Wakes those of the present workers that sleep.
    void call() {
        for (int worker = 1; worker < workers; ++worker) threads[static_cast<std::size_t>(worker - 1)]->call();
    }

    // The present call when it is another one than `seen`: polls for a while, then sleeps until called, and repeats.
    std::uint64_t await_round(std::uint64_t seen, PoolThread& self) {
        while (true) {
            const unsigned call = self.calls.load(std::memory_order_acquire);
            bool has_core = true;
            for (int i = 0; has_core && i < looks.load(std::memory_order_relaxed); ++i) {
                if (const auto now = round.load(std::memory_order_acquire); now != seen) return now;
                has_core = wait_a_little(i);
            }
            if (const auto now = round.load(std::memory_order_acquire); now != seen) return now;
            self.sleep(call);
        }
    }

    void work(int worker, PoolThread& self) {
        std::uint64_t seen = 0;
        while (true) {
            seen = await_round(seen, self);
            if (stops.load(std::memory_order_relaxed)) return;
            if (worker >= static_cast<int>(seen & max_byte)) continue;
            {
                const Zone of_task(zone);
                (*task)(worker);
            }
            if (running.fetch_sub(1, std::memory_order_seq_cst) == 1) running.notify_one();
        }
    }

    // Begins a call for `count` workers.
    void begin_round(int count) {
        const auto calls = (round.load(std::memory_order_relaxed) >> 8) + 1;
        round.store(calls << 8 | static_cast<std::uint64_t>(count), std::memory_order_release);
    }

    // How long the present workers, the calling thread among them, were ready to run and on a core so far, s; of no
    // core where the system does not tell.
    struct Times {
        double now = 0, ready = 0, core = 0;
    };
    Times times() const {
        Times result{.now = seconds_now()};
        const auto add = [&](double ready, double core) {
            if (core < 0) return;
            result.ready += ready;
            result.core += core;
        };
        add(result.now, core_seconds_here());
        for (int worker = 1; worker < std::min(workers, static_cast<int>(threads.size()) + 1); ++worker) {
            PoolThread& each = *threads[static_cast<std::size_t>(worker - 1)];
            add(result.now - each.slept_until(result.now), core_seconds(each.thread.native_handle()));
        }
        return result;
    }
};

TaskPool::StayAwake::StayAwake(TaskPool& pool) : pool_(pool) {
    pool_.state_->start();
    pool_.state_->looks.store(looks_while_awake, std::memory_order_relaxed);
    pool_.state_->call();
}

TaskPool::StayAwake::~StayAwake() { pool_.state_->looks.store(looks_between_tasks, std::memory_order_relaxed); }

TaskPool::TaskPool(int workers, Use use) : state_(std::make_unique<State>()) {
    EMBODY_ASSERT(workers >= 1 && workers <= max_byte);
    state_->workers = state_->max_workers = workers;
    if (use == Use::as_many_as_pay) state_->choice.emplace(workers);
}

TaskPool::~TaskPool() {
    State& s = *state_;
    s.stops.store(true, std::memory_order_relaxed);
    s.begin_round(0);
    for (const auto& each : s.threads) each->call();
    for (const auto& each : s.threads) each->thread.join();
}

int TaskPool::workers_that_pay() {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return std::clamp(threads / 2, std::min(threads, 2), 4);
}

int TaskPool::workers() const { return state_->workers; }
int TaskPool::max_workers() const { return state_->max_workers; }
TaskPool::Use TaskPool::use() const { return state_->choice ? Use::as_many_as_pay : Use::all; }

void TaskPool::run(const std::function<void(int)>& task) {
    State& s = *state_;
    if (s.workers == 1) return task(0);
    s.start();
    s.task = &task;
    s.zone = innermost_zone();
    s.running.store(s.workers - 1, std::memory_order_relaxed);
    s.begin_round(s.workers);
    s.call();
    task(0);
    await(s.running, [](int now) { return now == 0; });
}

TaskPool::Step::Step(TaskPool& pool) : pool_(pool) {
    State& s = *pool_.state_;
    if (!s.choice) return;
    s.workers = s.choice->workers();
    s.start();
    const State::Times times = s.times();
    begin_ = times.now;
    ready_begin_ = times.ready;
    core_begin_ = times.core;
}

TaskPool::Step::~Step() {
    State& s = *pool_.state_;
    if (!s.choice) return;
    const State::Times times = s.times();
    const double ready = times.ready - ready_begin_, core = times.core - core_begin_;
    s.choice->note(times.now - begin_, ready > 0 ? std::clamp(1 - core / ready, 0.0, 1.0) : 0);
}

}  // namespace embody
