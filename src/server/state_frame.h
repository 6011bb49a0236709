// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/session.h"

namespace embody::server {

/// The newest state of every entity, each with the version in which it last changed. A client that has seen version v
/// needs only what changed since: latest state wins, nothing is queued.
class StateBoard {
public:
    /// Takes the present states; entities that are missing are dropped. `all_changed` marks every one as new.
    void publish(const std::vector<scene::EntityState>& states, double time, std::uint64_t step, bool all_changed);

    [[nodiscard]] std::uint64_t version() const { return version_; }

    /// The binary frame (docs/protocol.md) of what changed after `seen`; empty where nothing did.
    [[nodiscard]] std::string frame_since(std::uint64_t seen) const;

private:
    struct Row {
        scene::EntityState state;  ///< without its points
        std::uint64_t changed = 0;
        std::string points;                ///< their record of the frame; empty: it has none
        std::uint64_t points_changed = 0;  ///< and when they last moved
    };
    [[nodiscard]] Row next_row(const scene::EntityState& state, bool all_changed);

    std::map<scene::EntityIndex, Row> rows_;
    std::uint64_t version_ = 0;
    double time_ = 0;
    std::uint64_t step_ = 0;
    std::vector<Vec3> scratch_;
};

}  // namespace embody::server
