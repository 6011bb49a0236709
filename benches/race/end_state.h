// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "benches/race/overlap.h"

namespace embody::race {

/// What a run ended in: a time counts only with this beside it, since a structure that fell is less work.
struct EndState {
    double kinetic_energy = 0;      ///< J
    double potential_energy = 0;    ///< J above the height 0
    std::optional<double> top_gap;  ///< highest centre above where it would be if nothing sank or fell, m
    Overlap overlap;
    int asleep = 0;
    std::string wrong;  ///< empty: as it must be; else why it is not
};

/// What is followed while an engine runs a scene.
class RunWatch {
public:
    explicit RunWatch(const RaceScene& scene);

    /// Before step `frame`, before its events.
    void before_frame(int frame, const RaceEngine& engine);
    /// An event is about to change the engine: its energy may be kept.
    void before_event(const RaceEvent& event, const RaceEngine& engine);
    /// After the last step.
    [[nodiscard]] EndState finish(const RaceEngine& engine) const;

private:
    /// Nothing has hit the structure, if it is one, up to now.
    [[nodiscard]] bool must_stand() const;
    [[nodiscard]] bool stands(const RaceEngine& engine) const;
    [[nodiscard]] double kinetic_energy(const RaceBody& body, const BodyState& state) const;
    [[nodiscard]] std::string judge(const EndState& end, bool standing) const;

    const RaceScene& scene_;
    std::vector<RaceBody> bodies_;  ///< with those that events added
    std::size_t top_body_ = 0;      ///< the highest at the start
    double energy_given_ = 0;       ///< at the start and by events, J
    int frames_ = 0;                ///< run up to now
    bool fell_early_ = false;       ///< before its event
};

}  // namespace embody::race
