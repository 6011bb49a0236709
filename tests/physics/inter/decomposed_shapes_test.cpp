// SPDX-License-Identifier: MIT
//
// Decomposed things do what they are for: a mug holds, a seat carries, a table leaves room beneath.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/decomposition/decomposition.h"
#include "geometry/furniture_meshes.h"
#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

CompoundShape parts_of(const geometry::TriangleMesh& mesh, int max_hulls = 16) {
    const auto made = geometry::decompose(mesh, {.max_hulls = max_hulls});
    EXPECT_TRUE(made.ok());
    CompoundShape compound;
    for (const geometry::ConvexHull& hull : made->hulls) compound.children.push_back({HullShape{hull.vertices}, {}});
    return compound;
}

struct Room {
    std::unique_ptr<World> world = make_world();

    Room() {
        const auto plane = world->create_shape(PlaneShape{}).value();
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = plane}));
    }
    BodyHandle add(const ShapeDefinition& shape, double mass, Vec3 position) {
        auto made = world->create_shape(shape);
        EXPECT_TRUE(made.ok()) << made.error().message();
        BodyDefinition body{.shape = made.value(), .position = position};
        body.mass.mass = mass;
        auto handle = world->create_body(body);
        EXPECT_TRUE(handle.ok()) << handle.error().message();
        return handle.value();
    }
    void run(double seconds) {
        const int steps = static_cast<int>(std::lround(seconds / world->settings().time_step));
        for (int i = 0; i < steps; ++i) world->step();
    }
    Vec3 position(BodyHandle body) const { return world->pose(body).position; }
    bool is_upright(BodyHandle body) const { return rotate(world->pose(body).rotation, {0, 1, 0}).y > 0.999; }
};

TEST(DecomposedShapes, AMugHoldsABallAlsoWhenItIsAnOpenSurface) {
    for (const auto& mesh : {geometry::make_mug(), geometry::make_open_mug()}) {
        Room room;
        const auto mug = room.add(parts_of(mesh), 0.3, {0, 0, 0});
        const auto ball = room.add(SphereShape{0.015}, 0.02, {0.01, 0.15, 0.005});
        room.run(2);
        const Vec3 inside = room.position(ball) - room.position(mug);
        EXPECT_LT(inside.y, 0.04);
        EXPECT_GT(inside.y, 0.014);
        EXPECT_LT(std::hypot(inside.x, inside.z), 0.03);
        EXPECT_TRUE(room.is_upright(mug));

        // Pushed away it takes the ball along.
        BodyDefinition pushed = *room.world->body(mug);
        ASSERT_TRUE(room.world->set_velocity(mug, {1, 0, 0}, {}));
        room.run(2);
        EXPECT_GT(room.position(mug).x, pushed.position.x + 0.05);
        EXPECT_LT(std::hypot(room.position(ball).x - room.position(mug).x, room.position(ball).z), 0.03);
        EXPECT_LT(room.position(ball).y, 0.04);
    }
}

TEST(DecomposedShapes, TheHullOfAMugHoldsNothing) {
    Room room;
    room.add(parts_of(geometry::make_mug(), 1), 0.3, {0, 0, 0});
    const auto ball = room.add(SphereShape{0.015}, 0.02, {0, 0.15, 0});
    room.run(1);
    EXPECT_GT(room.position(ball).y, 0.1);
}

TEST(DecomposedShapes, AChairsSeatCarries) {
    Room room;
    const auto chair = room.add(parts_of(geometry::make_chair()), 6, {0, 0, 0});
    const auto box = room.add(BoxShape{{0.1, 0.1, 0.1}}, 5, {0, 0.6, 0.02});
    const auto ball = room.add(SphereShape{0.1}, 1, {1, 0.1, 0});
    room.run(3);
    EXPECT_NEAR(room.position(box).y, 0.56, 2e-3);
    EXPECT_LT(std::hypot(room.position(box).x, room.position(box).z - 0.02), 5e-3);
    EXPECT_TRUE(room.is_upright(chair));
    EXPECT_EQ(room.world->sleep_state(chair), SleepState::asleep);
    EXPECT_EQ(room.world->sleep_state(box), SleepState::asleep);

    // Below the seat, between the legs, there is room: the ball rolls through from side to side.
    ASSERT_TRUE(room.world->set_velocity(ball, {-1.5, 0, 0}, {0, 0, 15}));
    room.run(2);
    EXPECT_LT(room.position(ball).x, -0.4);
    EXPECT_LT(std::hypot(room.position(chair).x, room.position(chair).z), 1e-3);
}

TEST(DecomposedShapes, ATableCanBeWalkedUnder) {
    Room room;
    const auto table = room.add(parts_of(geometry::make_table()), 25, {0, 0, 0});
    // Someone 68 cm tall and 40 cm wide, from end to end.
    auto shape = room.world->create_shape(CapsuleShape{0.2, 0.14});
    BodyDefinition walker{.kind = BodyKind::kinematic_body, .shape = shape.value(), .position = {-1.5, 0.36, 0}};
    walker.linear_velocity = {1, 0, 0};
    const auto body = room.world->create_body(walker).value();
    bool touched = false;
    for (int i = 0; i < 180; ++i) {
        room.world->step();
        for (const ContactView& contact : room.world->contacts()) {
            touched = touched || (contact.a == body && contact.b == table) || (contact.a == table && contact.b == body);
        }
    }
    EXPECT_GT(room.position(body).x, 1.4);
    EXPECT_FALSE(touched);
    EXPECT_LT(length(room.position(table)), 1e-3);

    // Who is taller pushes it along.
    Room other;
    const auto pushed = other.add(parts_of(geometry::make_table()), 25, {0, 0, 0});
    shape = other.world->create_shape(CapsuleShape{0.2, 0.4});
    walker.shape = shape.value();
    walker.position.y = 0.62;
    ASSERT_TRUE(other.world->create_body(walker));
    other.run(2);
    EXPECT_GT(other.position(pushed).x, 0.1);
}

}  // namespace
}  // namespace embody::physics
