// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "validation/golden_scenes.h"
#include "validation/reference.h"

namespace embody::physics {

/// A world whose ground is a plane.
inline GoldenScene on_plane(const WorldSettings& settings = {}, const Material& material = {}) {
    GoldenScene scene{make_world(settings)};
    add_plane(*scene.world, material);
    return scene;
}

/// Adds a body of that shape, else as `like` says.
inline BodyHandle add_shape(World& world, const ShapeDefinition& shape, const BodyDefinition& like) {
    BodyDefinition body = like;
    body.shape = world.create_shape(shape).value();
    return world.create_body(body).value();
}

inline BodyHandle add_ball(World& world, double radius, const BodyDefinition& like) {
    return add_shape(world, SphereShape{radius}, like);
}

/// A ball joint at these points of the two bodies.
inline void join(World& world, BodyHandle a, BodyHandle b, Vec3 on_a, Vec3 on_b) {
    EXPECT_TRUE(world.create_joint(
        {.joint = BallJoint{}, .body_a = a, .body_b = b, .frame_a = {on_a, {}}, .frame_b = {on_b, {}}}));
}

}  // namespace embody::physics
