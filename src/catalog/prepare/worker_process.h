// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catalog/prepare/worker_protocol.h"

namespace embody::catalog {

/// A worker process and its two pipes, as the parent sees it: everything that it sends is untrusted. Killed and reaped
/// at the end of this object's life.
class WorkerProcess {
public:
    using Clock = std::chrono::steady_clock;

    /// `address_space` in bytes; `readable`: see ConfinementOptions.
    static Result<WorkerProcess> start(const std::filesystem::path& program, std::size_t address_space,
                                       const std::vector<std::string>& readable);
    WorkerProcess(WorkerProcess&& other) noexcept;
    WorkerProcess& operator=(WorkerProcess&&) = delete;
    ~WorkerProcess();

    [[nodiscard]] int output() const { return from_worker_; }
    [[nodiscard]] int input() const { return to_worker_; }
    /// Time that its threads ran on processors so far, s.
    [[nodiscard]] double processor_seconds() const;
    /// From now on other programs have the processor first.
    void lower_priority() const;
    [[nodiscard]] bool has_unsent() const { return sent_ < outgoing_.size(); }

    /// Queues a frame for the worker; send_some() sends it.
    void queue(std::vector<std::uint8_t> frame);
    void send_some();
    /// Reads the bytes that are there. False when the worker closed its end.
    bool receive_some();

    struct Message {
        FrameKind kind = FrameKind::failed;
        std::vector<std::uint8_t> payload;
    };
    /// The next whole message, nothing where it is not all there yet, an error where the worker does not keep the
    /// protocol.
    Result<std::optional<Message>> take_message();

    /// Ends the process and says how it ended, for people: "was ended by signal 11 (Segmentation fault)".
    std::string finish();

private:
    WorkerProcess(pid_t process, int to_worker, int from_worker)
        : process_(process), to_worker_(to_worker), from_worker_(from_worker) {}

    pid_t process_ = -1;
    int to_worker_ = -1, from_worker_ = -1;
    std::vector<std::uint8_t> outgoing_, incoming_;
    std::size_t sent_ = 0;
};

}  // namespace embody::catalog
