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

/// Threads that do what is posted, in order, so that the network thread never waits for a disk, a database or the
/// scene.
class WorkQueue {
public:
    explicit WorkQueue(std::size_t threads);
    /// Ends after the work in hand; what waits is dropped.
    ~WorkQueue();

    /// From any thread. The work must not throw.
    void post(std::function<void()> work);

    /// From any thread: what is in hand is the last.
    void request_stop();
    /// Whether all threads have ended by then.
    bool wait_ended(std::chrono::steady_clock::time_point until);

private:
    void run();

    std::mutex mutex_;  ///< guards all below but the threads
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    std::size_t running_ = 0;  ///< threads that have not ended
    bool stop_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace embody::server
