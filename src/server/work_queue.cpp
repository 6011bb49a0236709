// SPDX-License-Identifier: MIT
#include "server/work_queue.h"

#include <utility>

namespace embody::server {

WorkQueue::WorkQueue(std::size_t threads) : running_(threads) {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

WorkQueue::~WorkQueue() {
    request_stop();
    for (std::thread& thread : threads_) thread.join();
}

void WorkQueue::post(std::function<void()> work) {
    {
        const std::lock_guard lock(mutex_);
        if (stop_) return;
        waiting_.push_back(std::move(work));
    }
    changed_.notify_one();
}

void WorkQueue::request_stop() {
    std::deque<std::function<void()>> dropped;
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        dropped.swap(waiting_);
    }
    changed_.notify_all();
}

bool WorkQueue::wait_ended(std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, until, [this] { return running_ == 0; });
}

void WorkQueue::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
        if (stop_) break;
        std::function<void()> work = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        work();
        work = nullptr;
        lock.lock();
    }
    --running_;
    // While the lock is held, because the waiting thread may destroy this object as soon as the lock is free.
    changed_.notify_all();
}

}  // namespace embody::server
