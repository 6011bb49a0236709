// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/session/session_state.h"

namespace embody::scene {

/// The entities with what there is between them: joints and pins whose ends are all among them or in the world, and
/// actions that name only such entities. A document of its own.
Document part_of(const Document& document, const std::vector<EntityIndex>& indices);

/// Gives all of the part numbers and names that are free in the document, and adds it, each thing moved by `motion`, to
/// the edit. Returns the new indices in the part's order. May be called several times for one edit.
class PartAdder {
public:
    PartAdder(SessionState& state, Edit& edit);
    ~PartAdder();
    PartAdder(const PartAdder&) = delete;
    PartAdder& operator=(const PartAdder&) = delete;

    Result<std::vector<EntityIndex>> add(const Document& part, const Transform& motion);

private:
    SessionState& state_;
    Edit& edit_;
    std::uint32_t next_joint_ = 1, next_action_ = 1;
    std::vector<std::string> names_;
    std::set<std::string> groups_;
};

}  // namespace embody::scene
