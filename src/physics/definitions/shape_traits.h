// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <vector>

#include "math/transform.h"
#include "math/vec3.h"

namespace embody::physics {

/// What scene files say that they expect of a shape's length.
inline constexpr const char* a_length = "a length in metres";

/// Calls visit(field, length, what is expected) for each length of what has an axis.
void round_lengths(auto& shape, auto&& visit) {
    visit("radius", shape.radius, a_length);
    visit("half_height", shape.half_height, a_length);
}

/// A shape that is no more than its lengths.
template <class Shape>
concept HasLengths = requires(Shape& shape) {
    Shape::lengths(shape, [](const char*, auto&, const char*) {});
};

/// A convex solid that is the hull of its corners, at least four that span a volume, about its origin or not.
template <class Shape>
concept HasCorners = requires(const Shape& shape) {
    { shape.corners() } -> std::convertible_to<std::vector<Vec3>>;
};

/// A shape that collides, weighs and is filled as the convex parts that it consists of.
template <class Shape>
concept HasParts = requires(const Shape& shape) {
    { shape.parts().front().local } -> std::convertible_to<Transform>;
};

}  // namespace embody::physics
