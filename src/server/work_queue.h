// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace embody::server {

/// Threads that run the posted functions in order, so that the network thread never waits for a disk, a database or the
/// scene.
class WorkQueue {
public:
    explicit WorkQueue(std::size_t threads);
    /// Ends after the current function; those that wait are dropped.
    ~WorkQueue();

    /// May be called from any thread. The function must not throw.
    void post(std::function<void()> work);

    /// May be called from any thread: the current function is the last.
    void request_stop();
    /// Waits until then; returns whether all threads have ended.
    bool wait_ended(std::chrono::steady_clock::time_point until);

private:
    void run();

    std::mutex mutex_;  ///< guards all members below but the threads
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    std::size_t running_ = 0;  ///< threads that have not ended
    bool stop_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace embody::server
