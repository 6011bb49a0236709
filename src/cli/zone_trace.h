// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "foundation/result.h"

namespace embody::cli {

/// Writes the zones of all threads (foundation/zone.h) while the object lives, in Chrome's trace event format, which
/// chrome://tracing, Perfetto and Speedscope read. take() writes zones to the file, so memory stays bounded.
class ZoneTrace {
public:
    /// Starts to record. Fails, with the file's name, where the file cannot be written.
    static Result<std::unique_ptr<ZoneTrace>> create(const std::filesystem::path& file);
    ~ZoneTrace();

    /// Writes the zones that ended since the last call; to be called after every step.
    Result<void> take();
    /// Writes the names of the threads and the end; the file is complete after this. Returns the number of zones that
    /// are missing because more ended between two calls of take() than the buffer holds.
    Result<std::uint64_t> finish();

private:
    ZoneTrace();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::cli
