// SPDX-License-Identifier: MIT
// What the world tells of a rope: tensions, and that it broke.
#include <gtest/gtest.h>

#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

// A rope of 1 m and 1 kg from the origin down, held at its top.
DeformableDefinition hanging_rope(double break_tension = 1e9) {
    DeformableDefinition rope = rope_between(
        {0, 0, 0}, {0, -1, 0}, 0.1,
        {.linear_density = 1, .axial_stiffness = 1e4, .rayleigh_damping = 0.02, .break_tension = break_tension});
    rope.pinned = {0};
    rope.user_data = 7;
    return rope;
}

TEST(RopeBreaks, TensionIsTheWeightBelow) {
    const auto world = make_world({.sleeping = false});
    const auto rope = world->create_deformable(hanging_rope());
    ASSERT_TRUE(rope);
    for (int i = 0; i < 300; ++i) world->step();
    const auto tensions = world->rope_tensions(*rope);
    ASSERT_EQ(tensions.size(), 10u);
    for (std::size_t s = 0; s < tensions.size(); ++s)
        EXPECT_NEAR(tensions[s], 9.81 * (0.95 - 0.1 * static_cast<double>(s)), 0.02) << s;
    EXPECT_TRUE(world->broken_segments(*rope).empty());
    EXPECT_TRUE(world->rope_tensions({}).empty());
}

TEST(RopeBreaks, AreReportedOnceWithPositionAndTension) {
    const auto world = make_world();
    const auto rope = world->create_deformable(hanging_rope(9));
    ASSERT_TRUE(rope);
    std::vector<RopeBreakEvent> told;
    for (int i = 0; i < 60; ++i) {
        world->step();
        for (const RopeBreakEvent& event : world->rope_break_events()) told.push_back(event);
    }
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].rope, *rope);
    EXPECT_EQ(told[0].user_data, 7u);
    EXPECT_EQ(told[0].segment, 0u);
    EXPECT_GT(told[0].tension, 9);
    EXPECT_LT(told[0].tension, 20);
    EXPECT_NEAR(told[0].position.y, -0.05, 0.01);
    EXPECT_EQ(world->broken_segments(*rope), (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(world->rope_tensions(*rope)[0], 0);

    // It stays broken when something else of it is changed.
    DeformableDefinition changed = hanging_rope(9);
    changed.material = {.friction_static = 0.1, .friction_dynamic = 0.1};
    ASSERT_TRUE(world->set_deformable(*rope, changed));
    EXPECT_EQ(world->broken_segments(*rope), (std::vector<std::uint32_t>{0}));
    world->step();
    EXPECT_TRUE(world->rope_break_events().empty());
    EXPECT_LT(world->node_positions(*rope)[10].y, -3) << "the rest falls on";
    ASSERT_TRUE(world->destroy_deformable(*rope));
    world->step();
    EXPECT_TRUE(world->rope_break_events().empty());
}

}  // namespace
}  // namespace embody::physics
