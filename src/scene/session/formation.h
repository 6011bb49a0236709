// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/session/placement.h"

namespace embody::scene {

/// Things that are put somewhere together and keep their places to each other.
class Formation {
public:
    /// Entities of the document at their present poses; `lead` is one of them, and the one that the pointer moves.
    Formation(SessionState& state, EntityIndex lead, const std::vector<EntityIndex>& indices);
    /// Entities that are not in the document; the first one leads.
    Formation(SessionState& state, std::vector<Entity> members);

    /// Puts the lead where the ray says and the others along, so high that none of them ends in something else.
    Result<Placement> place(const PointerRay& ray, bool snap);
    [[nodiscard]] const std::vector<Entity>& members() const { return members_; }

private:
    void follow(const Transform& lead);
    [[nodiscard]] double raised() const;

    SessionState& state_;
    std::size_t lead_ = 0;
    std::vector<Entity> members_;
    std::set<EntityIndex> ignored_;
};

}  // namespace embody::scene
