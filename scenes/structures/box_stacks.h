// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/inter/world.h"

namespace embody::scenes {

/// A body of that shape and density 1000 kg/m³.
Result<physics::BodyHandle> add_body(physics::World& world, const physics::ShapeDefinition& shape, Vec3 position,
                                     physics::BodyKind kind);

/// Boxes of 0.2 m in stacks of five, in rows from x = 1.5 m on: what else a scene has to step.
class BoxStacks {
public:
    static Result<BoxStacks> add(physics::World& world, int boxes);
    /// Whether all are where they were built, within 1 cm.
    [[nodiscard]] bool stand(const physics::World& world) const;

private:
    std::vector<physics::BodyHandle> tops_;
};

}  // namespace embody::scenes
