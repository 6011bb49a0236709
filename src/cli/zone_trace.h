// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "foundation/result.h"

namespace embody::cli {

/// Writes the zones of all threads (foundation/zone.h) while it lives, in Chrome's trace event format, which
/// chrome://tracing, Perfetto and Speedscope read. Zones are written as they are taken, so memory stays bounded.
class ZoneTrace {
public:
    /// Begins to record. Fails, with the file's name, where it cannot be written.
    static Result<std::unique_ptr<ZoneTrace>> create(const std::filesystem::path& file);
    ~ZoneTrace();

    /// Writes what ended since the last call; to be called after every step.
    Result<void> take();
    /// Writes the names of the threads and the end; the file is complete after this. Returns how many zones are missing
    /// because more ended between two calls of take() than there was room for.
    Result<std::uint64_t> finish();

private:
    ZoneTrace();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::cli
