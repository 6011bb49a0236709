// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "attributes/attribute.h"
#include "math/transform.h"
#include "scene/document/entity.h"

namespace embody::scene {

/// What of a thing's attributes decides where it is placed.
struct PlacementRules {
    std::string usual_place;  ///< the attribute `placement`
    std::string category;
    std::string front;       ///< the attribute `front`: "+z", "-z", "+x" or "-x"
    bool has_front = false;  ///< a model, or a primitive that stands for something
    bool belongs_to_walls = false;
    bool stands_on_floors_only = false;
};
PlacementRules placement_rules(const Entity& entity, const attributes::AttributeSet& acting);

/// The direction in which the thing faces, in its frame.
Vec3 front_of(const PlacementRules& rules);
/// `rotation` turned about the vertical so that `front` (in the thing's frame) points along `wanted` (horizontal).
Quat turned_to(Quat rotation, Vec3 front, Vec3 wanted);
/// `rotation` turned about the vertical by the least angle so that an axis of the thing is along or across `wanted`.
Quat squared_to(Quat rotation, Vec3 wanted);

}  // namespace embody::scene
