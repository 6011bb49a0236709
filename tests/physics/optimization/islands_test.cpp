// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "physics/optimization/island_sleep.h"
#include "physics/optimization/islands.h"

namespace embody::physics::optimization {
namespace {

ContactSummary between(std::uint32_t a, std::uint32_t b) {
    ContactSummary contact;
    contact.a = a;
    contact.b = b;
    return contact;
}

TEST(Islands, GroundDoesNotConnectAndLevelsCountFromIt) {
    // Body 0 is the ground; 1 and 2 stand on each other, 3 stands alone, 4 flies.
    std::vector<BodyState> bodies(5);
    for (std::size_t i = 1; i < 5; ++i) bodies[i].inverse_mass = 1;
    const std::vector<ContactSummary> contacts{between(1, 2), between(0, 3), between(0, 1)};
    const std::vector<std::uint32_t> awake{1, 2, 3, 4};
    Islands islands;
    build_islands(awake, bodies, contacts, {}, islands);
    ASSERT_EQ(islands.list.size(), 3u);
    EXPECT_EQ(islands.list[0].body_count, 2u);
    EXPECT_EQ(islands.list[0].contact_count, 2u);
    EXPECT_EQ(islands.list[0].deepest_level, 2u);
    EXPECT_EQ(islands.contacts[0], 2u) << "the contact with the ground comes first";
    EXPECT_EQ(islands.list[1].contact_count, 1u);
    EXPECT_EQ(islands.list[2].contact_count, 0u);
    EXPECT_EQ(islands.level[1], 1u);
    EXPECT_EQ(islands.level[2], 2u);
    EXPECT_EQ(islands.level[4], no_level);
}

TEST(Sleep, ThresholdScalesWithTheMassAndIsTrackedOverTime) {
    BodyConstants light, heavy;
    light.mass = 0.001;
    heavy.mass = 1000;
    BodyState slow;
    slow.linear_velocity = {0.02, 0, 0};
    SleepRecord a, b;
    a.threshold = b.threshold = 0.5 * 0.03 * 0.03;
    const QuietRules rules{.time_step = 1.0 / 60, .time_to_sleep = 0.5};
    for (int i = 0; i < 40; ++i) {
        track_quietness(a, slow, light, 0.1, rules);
        track_quietness(b, slow, heavy, 0.1, rules);
    }
    EXPECT_EQ(a.state, SleepState::wants_to_sleep);
    EXPECT_EQ(b.state, SleepState::wants_to_sleep);
    EXPECT_DOUBLE_EQ(a.quiet_time, b.quiet_time);
    const std::vector<SleepRecord> records{a, b};
    const std::vector<std::uint32_t> island{0, 1};
    EXPECT_TRUE(may_sleep(island, records, 0.5));
    slow.linear_velocity = {0.04, 0, 0};
    track_quietness(a, slow, light, 0.1, rules);
    EXPECT_EQ(a.state, SleepState::active);
    EXPECT_EQ(a.quiet_time, 0);
}

TEST(Sleep, WhatMovesOnSlowlyIsNotQuietForLong) {
    BodyConstants constants;
    constants.mass = 1;
    BodyState state;
    state.linear_velocity = {0.02, 0, 0};
    SleepRecord record;
    record.threshold = 0.5 * 0.03 * 0.03;
    for (int i = 0; i < 40; ++i) {
        state.center.x += 0.02 / 60;
        track_quietness(record, state, constants, 0.1, {.time_step = 1.0 / 60, .time_to_sleep = 0.5});
    }
    EXPECT_EQ(record.state, SleepState::wants_to_sleep);
    EXPECT_LT(record.quiet_time, 0.1);
}

}  // namespace
}  // namespace embody::physics::optimization
