// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

namespace embody::server {

/// How long counted work will still take, by its smoothed rate.
class RemainingTime {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// So many pieces are done now. Pieces that needed no work (`skipped`) do not count for the rate.
    void note(std::size_t done, std::size_t skipped, Time now);
    /// The clock does not count until the next note(): the work pauses.
    void pause() { last_.reset(); }
    /// Seconds for the pieces that are left; none before enough was measured to tell.
    [[nodiscard]] std::optional<double> seconds(std::size_t left) const;

private:
    struct Note {
        std::size_t worked = 0;
        Time time;
    };
    std::optional<Note> last_;
    double weighted_pieces_ = 0, weighted_seconds_ = 0;  ///< older work weighs less
    double measured_seconds_ = 0;
    std::size_t measured_pieces_ = 0;
};

}  // namespace embody::server
