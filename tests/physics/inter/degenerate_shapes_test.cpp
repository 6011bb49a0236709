// SPDX-License-Identifier: MIT
// Flat, thin, doubled, far and huge point clouds and sizes: a clear error, or a sound shape that falls and lies still.
#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

Vec3 random_point(Random& random, double half) {
    return {random.between(-half, half), random.between(-half, half), random.between(-half, half)};
}

HullShape box_corners(Vec3 half, int copies = 1) {
    HullShape hull;
    for (int i = 0; i < 8 * copies; ++i) {
        hull.points.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    }
    return hull;
}

TEST(DegenerateShapes, WithoutVolumeAreRefused) {
    const HullShape hulls[] = {
        {},
        {{{0, 0, 0}}},
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}},
        {{{0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.7}, {1, 1, 1}}},
        {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {-1, -1, -1}}},
        {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},
        box_corners({1, 1e-8, 1}),
        box_corners({1e-8, 1, 1e-8}),
    };
    const auto world = make_world();
    for (const HullShape& hull : hulls) {
        const auto shape = world->create_shape(hull);
        ASSERT_FALSE(shape.ok()) << hull.points.size() << " points";
        EXPECT_EQ(shape.error().where, "points");
        EXPECT_FALSE(shape.error().why.empty());
    }
}

// Falls on a plane for two seconds; returns its lowest point, m.
double lowest_after_fall(const ShapeDefinition& definition) {
    const auto world = make_world();
    const auto plane = world->create_shape(PlaneShape{}).value();
    EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = plane}));
    const auto shape = world->create_shape(definition);
    EXPECT_TRUE(shape.ok()) << shape.error().message();
    EXPECT_GT(world->volume(shape.value()).value(), 0);
    const auto body =
        world
            ->create_body(
                {.shape = shape.value(), .position = {0, 1.5, 0}, .rotation = normalized({0.1, 0.2, 0.3, 0.9})})
            .value();
    const Mat3 inertia = world->inertia(body);
    for (int k = 0; k < 3; ++k) EXPECT_GT(inertia(k, k), 0);
    for (int i = 0; i < 180; ++i) world->step();
    EXPECT_TRUE(is_finite(world->pose(body)));
    EXPECT_LT(length(world->linear_velocity(body)), 0.2);
    return world->bounds(body).lower.y;
}

TEST(DegenerateShapes, WithLittleVolumeFallAndLieStill) {
    Random random(5);
    HullShape ball, nearly_flat, roof = box_corners({1, 1, 1});
    for (int i = 0; i < 1000; ++i) ball.points.push_back(normalized(random_point(random, 1)));
    for (int i = 0; i < 50; ++i) nearly_flat.points.push_back(scale(random_point(random, 1), {1, 1e-3, 1}));
    for (int i = 0; i < 200; ++i) {
        roof.points.push_back({random.between(-1, 1), 1 + random.between(-1e-12, 1e-12), random.between(-1, 1)});
    }
    const ShapeDefinition shapes[] = {
        box_corners({1, 1, 1}, 20),
        box_corners({1, 1e-3, 1}),
        box_corners({1, 1e-4, 1}),
        box_corners({0.01, 1, 0.01}),
        ball,
        nearly_flat,
        roof,
        BoxShape{{1, 1e-3, 1}},
        CylinderShape{1, 1e-3},
        ConeShape{1, 1e-3},
        BoxShape{{0.01, 1, 0.01}},
        SphereShape{1e-3},
        BoxShape{{1e-3, 1e-3, 1e-3}},
    };
    for (const ShapeDefinition& shape : shapes) {
        SCOPED_TRACE(std::string(shape_name(shape)) + " " + std::to_string(&shape - shapes));
        EXPECT_GT(lowest_after_fall(shape), -0.002);
    }
}

TEST(DegenerateShapes, OfMeshesNeitherCrashNorCatchWrongly) {
    // Doubled, flat and inverted triangles beside a sound floor.
    MeshShape mesh{{{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                   {{0, 2, 1}, {0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 4, 4}, {0, 1, 2}}};
    const auto world = make_world();
    const auto floor = world->create_shape(mesh).value();
    ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = floor}));
    const ShapeDefinition shapes[] = {SphereShape{0.3}, BoxShape{{0.3, 0.3, 0.3}}, CapsuleShape{0.2, 0.3}};
    std::vector<BodyHandle> bodies;
    for (const ShapeDefinition& definition : shapes) {
        const auto shape = world->create_shape(definition).value();
        const Vec3 place{1.5 * static_cast<double>(bodies.size()) - 1.5, 1, 0.1};
        bodies.push_back(world->create_body({.shape = shape, .position = place}).value());
    }
    for (int i = 0; i < 180; ++i) world->step();
    for (const BodyHandle body : bodies) EXPECT_GT(world->bounds(body).lower.y, -0.01);
}

}  // namespace
}  // namespace embody::physics
