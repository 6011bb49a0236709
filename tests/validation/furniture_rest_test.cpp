// SPDX-License-Identifier: MIT
//
// Furniture that is dropped comes to rest. Each time a rocking body changes feet it loses energy (G. Housner, "The
// behavior of inverted pendulum structures during earthquakes", 1963: for this chair about half of it), so rocking must
// die within seconds. Found in the Studio: real chairs rocked from foot to foot for ever, pushed up from small overlaps
// at each landing.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

/// A chair's hull: four feet, a seat, a back; centre of mass and inertia as of a real plastic chair of 6.9 kg.
BodyDefinition chair(World& world) {
    BodyDefinition body;
    // Real feet are round and not all of one height.
    HullShape hull;
    Random random(3);
    for (const double x : {-0.234, 0.234}) {
        for (const double z : {-0.146, 0.25}) {
            for (int i = 0; i < 12; ++i) {
                const double angle = 2 * std::numbers::pi * i / 12;
                hull.points.push_back(
                    {x + 0.015 * std::cos(angle), random.between(0, 0.0004), z + 0.015 * std::sin(angle)});
            }
        }
        hull.points.push_back({0.85 * x, 0.45, 0.27});
        hull.points.push_back({0.85 * x, 0.965, -0.28});
    }
    body.shape = *world.create_shape(hull);
    body.mass.mass = 6.9;
    body.mass.center_of_mass = Vec3{0, 0.496, -0.02};
    body.mass.inertia = Mat3{{0.678, 0, 0}, {0, 0.424, 0.1445}, {0, 0.1445, 0.648}};
    body.material.friction_static = 0.35;
    body.material.friction_dynamic = 0.25;
    return body;
}

class FurnitureComesToRest : public ::testing::TestWithParam<double> {};

TEST_P(FurnitureComesToRest, WhenDroppedOnAPlane) {
    for (const double height : {0.001, 0.1, 0.5}) {
        for (const double tilt : {0.0, 0.02, 0.2}) {
            auto world = make_world();
            BodyDefinition floor;
            floor.kind = BodyKind::static_body;
            floor.shape = *world->create_shape(PlaneShape{});
            floor.material.restitution = 0;
            ASSERT_TRUE(world->create_body(floor));
            BodyDefinition body = chair(*world);
            body.material.restitution = GetParam();
            body.rotation = from_axis_angle(normalized(Vec3{0.3, 0, 1}), tilt);
            const BodyHandle handle = *world->create_body(body);
            ASSERT_TRUE(world->set_pose(handle, {{0, height - world->bounds(handle).lower.y, 0}, body.rotation}));
            double lowest = 1;
            int steps = 0;
            while (steps < 600 && world->sleep_state(handle) != SleepState::asleep) {
                world->step();
                ++steps;
                // The deepest foot, wherever the chair ends up.
                lowest = std::min(lowest, world->bounds(handle).lower.y);
            }
            EXPECT_EQ(world->sleep_state(handle), SleepState::asleep)
                << "restitution " << GetParam() << ", dropped from " << height << " m, tilted by " << tilt << " rad";
            EXPECT_GT(lowest, -0.006) << "dropped from " << height << " m, tilted by " << tilt << " rad";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Restitution, FurnitureComesToRest, ::testing::Values(0.0, 0.3, 0.55));

/// Hulls as models give them: a flat thing whose lower side is many small faces, none of them quite level.
HullShape rough_slab(double length, double height, double width, int points) {
    HullShape hull;
    Random random(11);
    for (int i = 0; i < points; ++i) {
        const double x = random.between(-1, 1), z = random.between(-1, 1);
        const double rough = random.between(0, 0.001);
        hull.points.push_back({x * length / 2, i % 2 == 0 ? rough : height - rough, z * width / 2});
    }
    return hull;
}

HullShape cup(double radius, double height, int around) {
    HullShape hull;
    Random random(12);
    for (int i = 0; i < around; ++i) {
        const double angle = 2 * std::numbers::pi * i / around;
        for (const bool is_top : {false, true}) {
            const double r = (is_top ? 1.0 : 0.8) * radius;
            const double y = is_top ? height : random.between(0, 0.01 * height);
            hull.points.push_back({r * std::cos(angle), y, r * std::sin(angle)});
        }
    }
    return hull;
}

// Found in the Studio: books and cups trembled for ever and sank up to 22 mm into a box, because the face they were
// taken to stand on was another sliver of their side in each step.
TEST(RichHullOnABox, LiesStillAndDoesNotSink) {
    for (const HullShape& hull : {rough_slab(0.28, 0.024, 0.18, 250), cup(0.06, 0.068, 120)}) {
        WorldSettings settings;
        settings.sleeping = false;
        auto world = make_world(settings);
        BodyDefinition floor;
        floor.kind = BodyKind::static_body;
        floor.shape = *world->create_shape(BoxShape{{15, 0.25, 15}});
        floor.position = {0, -0.25, 0};
        ASSERT_TRUE(world->create_body(floor));
        BodyDefinition body;
        body.shape = *world->create_shape(hull);
        body.mass.mass = 1;
        const BodyHandle handle = *world->create_body(body);
        ASSERT_TRUE(world->set_pose(handle, {{0, 0.002 - world->bounds(handle).lower.y, 0}, {}}));
        for (int i = 0; i < 120; ++i) world->step();
        double fastest = 0, lowest = 1;
        for (int i = 0; i < 240; ++i) {
            world->step();
            fastest = std::max(fastest, length(world->linear_velocity(handle)));
            lowest = std::min(lowest, world->bounds(handle).lower.y);
        }
        EXPECT_LT(fastest, 1e-3) << hull.points.size() << " points";
        EXPECT_GT(lowest, -1e-3) << hull.points.size() << " points";
    }
}

}  // namespace
}  // namespace embody::physics
