// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>

#include "physics/inter/world.h"
#include "scene/embody/geometry_key.h"

namespace embody::scene {

/// Shapes in a world that several bodies use: one shape for each key, as long as a body uses it.
class SharedShapes {
public:
    /// `world` outlives them.
    explicit SharedShapes(physics::World& world) : world_(world) {}

    /// The shape of this key, made if it does not exist; a shape with an unshared key belongs to its caller.
    Result<physics::ShapeHandle> take(const GeometryKey& key,
                                      const std::function<Result<physics::ShapeDefinition>()>& make);
    /// Call only after the body that used it is removed or has another. A null shape is ignored.
    void release(const GeometryKey& key, physics::ShapeHandle shape);

private:
    struct Shared {
        physics::ShapeHandle shape;
        int users = 0;
    };
    physics::World& world_;
    std::map<GeometryKey, Shared> shapes_;
};

}  // namespace embody::scene
