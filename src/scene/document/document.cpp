// SPDX-License-Identifier: MIT
#include "scene/document/document.h"

#include <algorithm>

namespace embody::scene {

namespace {

template <class Items>
auto* find_item(Items& items, std::uint32_t index) {
    const auto found = std::lower_bound(items.begin(), items.end(), index,
                                        [](const auto& item, std::uint32_t wanted) { return item.index < wanted; });
    return found != items.end() && found->index == index ? &*found : nullptr;
}

}  // namespace

const Entity* Document::find(EntityIndex index) const { return find_item(entities, index); }
Entity* Document::find(EntityIndex index) { return find_item(entities, index); }
const SceneJoint* Document::find_joint(std::uint32_t index) const { return find_item(joints, index); }

}  // namespace embody::scene
