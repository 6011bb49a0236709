// SPDX-License-Identifier: MIT
#include "scenes/structures/box_stacks.h"

#include <algorithm>
#include <cmath>

namespace embody::scenes {

namespace {

using namespace physics;

constexpr int stack_height = 5;
constexpr double half_side = 0.1;

}  // namespace

Result<BodyHandle> add_body(World& world, const ShapeDefinition& definition, Vec3 position, BodyKind kind) {
    const auto shape = world.create_shape(definition);
    if (!shape) return shape.error();
    return world.create_body({.kind = kind, .shape = *shape, .position = position});
}

Result<BoxStacks> BoxStacks::add(World& world, int boxes) {
    BoxStacks stacks;
    for (int i = 0; i < boxes; ++i) {
        const int stack = i / stack_height, layer = i % stack_height;
        const Vec3 position{1.5 + 3 * half_side * (stack % 10), half_side * (1 + 2 * layer),
                            3 * half_side * (stack / 10) - 6 * half_side};
        const auto box = add_body(world, BoxShape{{half_side, half_side, half_side}}, position, BodyKind::dynamic_body);
        if (!box) return box.error();
        if (layer == stack_height - 1) stacks.tops_.push_back(*box);
    }
    return stacks;
}

bool BoxStacks::stand(const World& world) const {
    return std::ranges::all_of(tops_, [&](BodyHandle top) {
        return std::fabs(world.pose(top).position.y - half_side * (2 * stack_height - 1)) < 0.01;
    });
}

}  // namespace embody::scenes
