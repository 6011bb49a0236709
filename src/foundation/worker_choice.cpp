// SPDX-License-Identifier: MIT
#include "foundation/worker_choice.h"

#include <algorithm>
#include <numeric>

namespace embody {

namespace {

template <std::size_t N>
double sum(const std::array<double, N>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

void WorkerChoice::note(double seconds, double fraction_without_core) {
    if (max_workers_ == 1) return;

    // A trial ends as soon as it has taken longer than what it is compared with.
    if (is_trial()) {
        trial_seconds_[trial_count_++] = seconds;
        const bool is_slower = sum(trial_seconds_) >= sum(settled_seconds_);
        if (is_slower || trial_count_ == trial_steps) end_trial(!is_slower);
        return;
    }

    settled_seconds_[settled_count_ % trial_steps] = seconds;
    without_core_[settled_count_++ % trial_steps] = fraction_without_core;
    ++steps_since_;
    if (settled_count_ < trial_steps) return;

    // Kept from the cores with more than one worker: fewer may be faster, and this is not the time to wait for it.
    const bool is_disturbed = settled_ > 1 && sum(without_core_) > disturbing_fraction * trial_steps;
    if (is_disturbed && !was_disturbed_) steps_between_ = min_steps_between;
    was_disturbed_ = is_disturbed;
    const int longest = is_disturbed || settled_ < max_workers_ ? max_steps_between_with_fewer : max_steps_between;
    if (steps_since_ >= std::min(steps_between_, longest)) begin_trial();
}

void WorkerChoice::begin_trial() {
    // Each other number by turns, from the larger ones down: what is best need not be next to what is.
    do last_tried_ = last_tried_ > 1 ? last_tried_ - 1 : max_workers_;
    while (last_tried_ == settled_);
    tried_ = last_tried_;
    trial_seconds_ = {};
    trial_count_ = 0;
}

void WorkerChoice::end_trial(bool is_better) {
    if (is_better) {
        settled_ = tried_;
        settled_seconds_ = trial_seconds_;
        without_core_ = {};
        steps_between_ = min_steps_between;
    } else {
        tried_ = settled_;
        steps_between_ = std::min(2 * steps_between_, max_steps_between);
    }
    steps_since_ = 0;
}

}  // namespace embody
