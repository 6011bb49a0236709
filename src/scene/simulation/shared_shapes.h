// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>

#include "physics/inter/world.h"
#include "scene/embody/geometry_key.h"

namespace embody::scene {

/// Shapes in a world that several bodies have: what has the same key is there once, for as long as somebody has it.
class SharedShapes {
public:
    /// `world` outlives them.
    explicit SharedShapes(physics::World& world) : world_(world) {}

    /// The shape of this key, made where it is not there yet; one that is not shared is its taker's own.
    Result<physics::ShapeHandle> take(const GeometryKey& key,
                                      const std::function<Result<physics::ShapeDefinition>()>& make);
    /// Only after the body that used it is gone or has another. A null shape is none.
    void give_back(const GeometryKey& key, physics::ShapeHandle shape);

private:
    struct Shared {
        physics::ShapeHandle shape;
        int users = 0;
    };
    physics::World& world_;
    std::map<GeometryKey, Shared> shapes_;
};

}  // namespace embody::scene
