// SPDX-License-Identifier: MIT
#include "scene/simulation/shared_shapes.h"

namespace embody::scene {

using physics::ShapeHandle;

Result<ShapeHandle> SharedShapes::take(const GeometryKey& key,
                                       const std::function<Result<physics::ShapeDefinition>()>& make) {
    const auto known = shapes_.find(key);
    if (key.is_shared() && known != shapes_.end()) {
        ++known->second.users;
        return known->second.shape;
    }
    const Result<physics::ShapeDefinition> definition = make();
    if (!definition.ok()) return definition.error();
    const Result<ShapeHandle> shape = world_.create_shape(definition.value());
    if (!shape.ok()) return Error{"shape: " + shape.error().where, shape.error().why, shape.error().remedy};
    if (key.is_shared()) shapes_[key] = {shape.value(), 1};
    return shape;
}

void SharedShapes::release(const GeometryKey& key, ShapeHandle shape) {
    if (shape.is_null()) return;
    if (const auto known = shapes_.find(key); key.is_shared() && known != shapes_.end()) {
        if (--known->second.users > 0) return;
        shapes_.erase(known);
    }
    // No body has the shape any more, so that the world does not refuse.
    (void)world_.destroy_shape(shape).ok();
}

}  // namespace embody::scene
