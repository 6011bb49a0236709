// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "scene/simulation/simulation.h"

namespace embody::scene {

/// Two bodies began to touch in the last step.
struct Impact {
    physics::BodyHandle a, b;
    Vec3 position;       ///< world, m
    double impulse = 0;  ///< N s, normal and friction part together
};

/// The new contacts of the last step that `is_meant` accepts. Costs no more than a look at the step's events where
/// there are none.
std::vector<Impact> new_impacts(const Simulation& simulation,
                                const std::function<bool(const physics::ContactEvent&)>& is_meant);

/// Limits how often something is told, in simulated and in wall time: single steps run as fast as the machine can.
class Pace {
public:
    explicit Pace(double per_second) : period_(1 / per_second) {}
    /// Whether it may be told now, at this simulated time (s); if so the next time is later. A new run begins at 0.
    bool is_due(double simulated);

private:
    using Clock = std::chrono::steady_clock;
    double period_;  ///< s
    double last_ = -1e9;
    Clock::time_point next_{};
};

/// The strongest impacts since they were last taken.
class StrongestImpacts {
public:
    void add(const std::vector<Impact>& impacts);
    /// Strongest first.
    std::vector<Impact> take();
    [[nodiscard]] bool empty() const { return impacts_.empty(); }

private:
    std::vector<Impact> impacts_;
};

}  // namespace embody::scene
