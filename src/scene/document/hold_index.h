// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "scene/document/document.h"

namespace embody::scene {

/// Pins and joints by the entity that they hold, so that all entities need not be searched.
class HoldIndex {
public:
    void add_pins(EntityIndex of, const std::vector<Pin>& pins) {
        for (const Pin& pin : pins)
            if (pin.to) pinned_to_[*pin.to].insert(of);
    }
    void remove_pins(EntityIndex of, const std::vector<Pin>& pins) {
        for (const Pin& pin : pins)
            if (pin.to) remove(pinned_to_, *pin.to, of);
    }
    void add_joint(const SceneJoint& joint) {
        joints_of_[joint.entity_b].insert(joint.index);
        if (joint.entity_a) joints_of_[*joint.entity_a].insert(joint.index);
    }
    void remove_joint(const SceneJoint& joint) {
        remove(joints_of_, joint.entity_b, joint.index);
        if (joint.entity_a) remove(joints_of_, *joint.entity_a, joint.index);
    }

    /// Entities with a pin to the entity, ascending; the entity may not exist yet.
    [[nodiscard]] const std::set<EntityIndex>& pinned_to(EntityIndex entity) const { return find(pinned_to_, entity); }
    /// Joints with an end at the entity, ascending.
    [[nodiscard]] const std::set<std::uint32_t>& joints_of(EntityIndex entity) const {
        return find(joints_of_, entity);
    }

private:
    using Table = std::map<EntityIndex, std::set<std::uint32_t>>;
    static void remove(Table& table, EntityIndex entity, std::uint32_t holder) {
        const auto found = table.find(entity);
        if (found == table.end()) return;
        found->second.erase(holder);
        if (found->second.empty()) table.erase(found);
    }
    static const std::set<std::uint32_t>& find(const Table& table, EntityIndex entity) {
        static const std::set<std::uint32_t> nobody;
        const auto found = table.find(entity);
        return found == table.end() ? nobody : found->second;
    }

    Table pinned_to_, joints_of_;
};

}  // namespace embody::scene
