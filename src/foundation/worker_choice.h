// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace embody {

/// Chooses how many workers pay for work that comes again and again, such as the steps of a simulation, by how long it
/// takes. Workers of one task wait for each other, so where other programs hold a core, two workers can be slower than
/// one. From time to time a few steps are tried with another number; who is faster stays. Trials are rare as long as
/// they show nothing new, and come at once when threads are kept from the cores. Where results do not depend on the
/// number of workers, as in all of the physics, the choice changes nothing but the time.
class WorkerChoice {
public:
    /// Begins with all of `max_workers` >= 1.
    explicit WorkerChoice(int max_workers)
        : max_workers_(max_workers), settled_(max_workers), tried_(max_workers), last_tried_(max_workers) {}

    /// For the next step.
    [[nodiscard]] int workers() const { return tried_; }
    /// Tells of a step with workers(): how long it took, s, and the fraction of that time in which its threads were
    /// ready to run but had no core, 0 … 1.
    void note(double seconds, double fraction_without_core);

    /// Steps of a trial, and of what it is compared with.
    static constexpr std::size_t trial_steps = 4;
    /// Steps between trials: after one that changed the number; at most while all workers run, and while fewer do,
    /// since then a core may have become free.
    static constexpr int min_steps_between = 8, max_steps_between = 1024, max_steps_between_with_fewer = 128;
    /// Threads count as kept from the cores from this fraction on: a step of two threads then takes about a tenth
    /// longer.
    static constexpr double disturbing_fraction = 0.05;

private:
    void begin_trial();
    void end_trial(bool is_better);
    [[nodiscard]] bool is_trial() const { return tried_ != settled_; }

    const int max_workers_;
    int settled_;                 ///< what was the fastest so far
    int tried_;                   ///< other than settled_ in a trial
    int last_tried_;              ///< number of the last trial
    bool was_disturbed_ = false;  ///< in the last settled step threads were kept from the cores
    int steps_between_ = max_steps_between, steps_since_ = 0;
    std::array<double, trial_steps> settled_seconds_{}, trial_seconds_{};  ///< of the last steps
    std::array<double, trial_steps> without_core_{};                       ///< of the last settled steps
    std::size_t settled_count_ = 0, trial_count_ = 0;
};

}  // namespace embody
