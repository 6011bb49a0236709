// SPDX-License-Identifier: MIT
#include "scene/document.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/scene_file.h"

namespace embody::scene {

namespace {

template <class Entities>
auto* find_entity(Entities& entities, EntityIndex index) {
    const auto found = std::lower_bound(entities.begin(), entities.end(), index,
                                        [](const Entity& entity, EntityIndex wanted) { return entity.index < wanted; });
    return found != entities.end() && found->index == index ? &*found : nullptr;
}

}  // namespace

const Entity* Document::find(EntityIndex index) const { return find_entity(entities, index); }
Entity* Document::find(EntityIndex index) { return find_entity(entities, index); }

bool operator==(const Document& a, const Document& b) { return document_to_json(a) == document_to_json(b); }

}  // namespace embody::scene
