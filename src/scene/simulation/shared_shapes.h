// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>

#include "physics/inter/world.h"

namespace embody::scene {

/// Shapes in a world that several bodies have: what has the same key is there once, for as long as somebody has it.
class SharedShapes {
public:
    /// `world` outlives them.
    explicit SharedShapes(physics::World& world) : world_(world) {}

    /// The shape of this key, made where it is not there yet; one without a key is its taker's own.
    Result<physics::ShapeHandle> take(const std::string& key,
                                      const std::function<Result<physics::ShapeDefinition>()>& make);
    /// Only after the body that used it is gone or has another. A null shape is none.
    void give_back(const std::string& key, physics::ShapeHandle shape);

private:
    struct Shared {
        physics::ShapeHandle shape;
        int users = 0;
    };
    physics::World& world_;
    std::map<std::string, Shared> shapes_;
};

}  // namespace embody::scene
