// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scene/session/session.h"

namespace embody::server {

/// The newest state of every entity, each with the version in which it last changed. A client that has seen version v
/// needs only what changed since: the newest state wins, nothing is queued. One thread publishes while others read;
/// neither waits for the other.
class StateBoard {
public:
    /// Takes the present states, ascending by entity; entities that are missing are removed. `all_changed` marks every
    /// state as new.
    void publish(const std::vector<scene::EntityState>& states, double time, std::uint64_t step, bool all_changed);

    [[nodiscard]] std::uint64_t version() const { return table()->version; }

    /// Binary frame (docs/protocol.md) of what changed after version `seen`, and the version after applying it.
    struct Frame {
        std::string bytes;  ///< empty: nothing new
        std::uint64_t version = 0;
    };
    [[nodiscard]] Frame frame_since(std::uint64_t seen) const;

private:
    struct Row {
        scene::EntityState state;  ///< without its points
        std::uint64_t changed = 0;
        std::shared_ptr<const std::string> points;  ///< record of the points in the frame; null: there are none
        std::uint64_t points_changed = 0;           ///< version in which the points last moved
    };
    struct Table {
        std::vector<Row> rows;  ///< ascending by entity
        std::uint64_t version = 0;
        double time = 0;
        std::uint64_t step = 0;
    };
    [[nodiscard]] Row next_row(const scene::EntityState& state, const Row* known, std::uint64_t version);
    [[nodiscard]] std::shared_ptr<const Table> table() const;

    mutable std::mutex mutex_;  ///< guards the pointer; the table itself never changes
    std::shared_ptr<const Table> table_ = std::make_shared<Table>();
    std::vector<Vec3> scratch_;
};

}  // namespace embody::server
