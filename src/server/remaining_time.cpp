// SPDX-License-Identifier: MIT
#include "server/remaining_time.h"

#include <cmath>

namespace embody::server {
namespace {

/// Time after which work weighs 1/e in the rate, s: long, because models that follow each other are of one maker, and
/// differ from the next maker's.
constexpr double memory = 20;
/// A rate of less time or fewer pieces than this would jump.
constexpr double least_seconds = 3;
constexpr std::size_t least_pieces = 8;

}  // namespace

void RemainingTime::note(std::size_t done, std::size_t skipped, Time now) {
    const std::size_t worked = done > skipped ? done - skipped : 0;
    if (last_ && worked >= last_->worked) {
        const double seconds = std::chrono::duration<double>(now - last_->time).count();
        const std::size_t pieces = worked - last_->worked;
        const double kept = std::exp(-seconds / memory);
        weighted_pieces_ = kept * weighted_pieces_ + static_cast<double>(pieces);
        weighted_seconds_ = kept * weighted_seconds_ + seconds;
        measured_seconds_ += seconds;
        measured_pieces_ += pieces;
    }
    last_ = Note{worked, now};
}

std::optional<double> RemainingTime::seconds(std::size_t left) const {
    if (left == 0) return 0.0;
    if (measured_seconds_ < least_seconds || measured_pieces_ < least_pieces || weighted_pieces_ <= 0) return {};
    return static_cast<double>(left) * weighted_seconds_ / weighted_pieces_;
}

}  // namespace embody::server
