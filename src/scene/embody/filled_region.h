// SPDX-License-Identifier: MIT
#pragma once

#include <variant>
#include <vector>

#include "foundation/result.h"
#include "geometry/convex_hull.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// The inside of a shape that will be filled, in the shape's frame.
class FilledRegion {
public:
    /// The error says why the shape has no inside.
    static Result<FilledRegion> of(const physics::ShapeDefinition& shape);

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Whether the whole ball is inside one of the convex parts.
    [[nodiscard]] bool holds_ball(Vec3 center, double radius) const;

private:
    struct Part {
        std::variant<physics::SphereShape, physics::BoxShape, physics::CapsuleShape, physics::CylinderShape,
                     physics::ConeShape, geometry::ConvexHull>
            shape;
        Transform pose;
        Bounds bounds;
    };
    template <class Primitive>
    static Result<Part> part_of(const Primitive& primitive, const Transform& pose);

    std::vector<Part> parts_;
    Bounds bounds_;
};

}  // namespace embody::scene
