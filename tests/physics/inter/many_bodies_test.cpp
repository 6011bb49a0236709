// SPDX-License-Identifier: MIT
// Changes of many bodies at once: all or none, as one by one.
#include <gtest/gtest.h>

#include <algorithm>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

struct Pile {
    std::unique_ptr<World> world = make_world();
    std::vector<BodyHandle> balls;
    Pile() {
        BodyDefinition floor{.kind = BodyKind::static_body, .shape = world->create_shape(PlaneShape{}).value()};
        EXPECT_TRUE(world->create_body(floor).ok());
        BodyDefinition ball{.shape = world->create_shape(SphereShape{0.1}).value()};
        ball.material.friction_rolling = 0.01;
        for (int i = 0; i < 8; ++i) {
            ball.position = {0, 0.1 + 0.2 * i, 0};
            balls.push_back(world->create_body(ball).value());
        }
        for (int i = 0; i < 5; ++i) world->step();
    }
};

TEST(ManyBodies, RefuseAsAWhole) {
    Pile pile;
    const std::uint64_t before = pile.world->state_hash();
    const auto poison = [&](BodyDefinition& ball) {
        if (ball.position.y > 1) ball.gravity_factor = 1e9;
    };
    const auto changed = pile.world->change_bodies(pile.balls, poison);
    ASSERT_FALSE(changed.ok());
    EXPECT_EQ(changed.error().where, "gravity_factor");
    std::vector<BodyHandle> stale = pile.balls;
    stale.push_back({});
    EXPECT_FALSE(pile.world->destroy_bodies(stale).ok());
    EXPECT_FALSE(pile.world->change_bodies(stale, [](BodyDefinition&) {}).ok());
    EXPECT_EQ(pile.world->state_hash(), before);
}

TEST(ManyBodies, MoveOnAsIfEachHadBeenChangedAlone) {
    Pile together, alone;
    const auto push = [](BodyDefinition& ball) { ball.linear_velocity.x += 1; };
    ASSERT_TRUE(together.world->change_bodies(together.balls, push).ok());
    for (const BodyHandle ball : alone.balls) {
        BodyDefinition definition = *alone.world->body(ball);
        push(definition);
        ASSERT_TRUE(alone.world->set_body(ball, definition).ok());
    }
    for (int i = 0; i < 30; ++i) {
        together.world->step();
        alone.world->step();
    }
    EXPECT_EQ(together.world->state_hash(), alone.world->state_hash());
}

TEST(ManyBodies, AreDestroyedTogetherAndWakeWhatLayOnThem) {
    Pile pile;
    for (int i = 0; i < 300; ++i) pile.world->step();
    EXPECT_EQ(pile.world->sleep_state(pile.balls.back()), SleepState::asleep);
    const std::span<const BodyHandle> lower = std::span(pile.balls).first(4);
    ASSERT_TRUE(pile.world->destroy_bodies(lower).ok());
    for (const BodyHandle ball : lower) EXPECT_FALSE(pile.world->contains(ball));
    EXPECT_EQ(pile.world->bodies().size(), 5u);
    for (int i = 0; i < 60; ++i) pile.world->step();
    EXPECT_NEAR(pile.world->pose(pile.balls[4]).position.y, 0.1, 0.01);
}

TEST(ManyBodies, FallThroughWhatIsIgnored) {
    Pile pile;
    const double to_floor = pile.world->pose(pile.balls.back()).position.y - 0.1;
    const BodyHandle top = pile.balls.back();
    const auto next = pile.world->drop_distance(top, 10);
    ASSERT_TRUE(next.has_value());
    EXPECT_LT(*next, 0.01);
    const auto others = [&](BodyHandle body) { return std::ranges::find(pile.balls, body) != pile.balls.end(); };
    const auto floor = pile.world->drop_distance(top, 10, others);
    ASSERT_TRUE(floor.has_value());
    EXPECT_NEAR(*floor, to_floor, 1e-5);
}

}  // namespace
}  // namespace embody::physics
