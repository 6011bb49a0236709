// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "benches/race/overlap.h"

namespace embody::race {

/// The end state of a run: a time counts only together with it, because a structure that fell is less work.
struct EndState {
    double kinetic_energy = 0;      ///< J
    double potential_energy = 0;    ///< J above the height 0
    std::optional<double> top_gap;  ///< height of the highest centre over its height without sinking and falling, m
    Overlap overlap;
    int asleep = 0;
    std::string wrong;  ///< empty: correct; else the reason why it is not
};

/// Observes an engine while it runs a scene.
class RunWatch {
public:
    explicit RunWatch(const RaceScene& scene);

    /// To be called before step `frame` and before its events.
    void before_frame(int frame, const RaceEngine& engine);
    /// To be called before an event changes the engine: stores the engine's energy if needed.
    void before_event(const RaceEvent& event, const RaceEngine& engine);
    /// To be called after the last step.
    [[nodiscard]] EndState finish(const RaceEngine& engine) const;

private:
    /// Whether the scene is a structure that nothing has hit up to now.
    [[nodiscard]] bool must_stand() const;
    [[nodiscard]] bool stands(const RaceEngine& engine) const;
    [[nodiscard]] double kinetic_energy(const RaceBody& body, const BodyState& state) const;
    [[nodiscard]] std::string judge(const EndState& end, bool standing) const;

    const RaceScene& scene_;
    std::vector<RaceBody> bodies_;  ///< including those that events added
    std::size_t top_body_ = 0;      ///< the highest body at the start
    double energy_given_ = 0;       ///< energy at the start and by events, J
    int frames_ = 0;                ///< run up to now
    bool fell_early_ = false;       ///< before the event that hits it
};

}  // namespace embody::race
