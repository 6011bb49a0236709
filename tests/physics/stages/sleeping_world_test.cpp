// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>

#include "physics/inter/world.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/world_state.h"

namespace embody::physics::stages {
namespace {

/// Three columns of two cubes, five metres apart, run until all sleep.
class SleepingWorld : public ::testing::Test {
protected:
    void SetUp() override {
        auto made = World::create();
        ASSERT_TRUE(made);
        world_ = std::move(*made);
        cube_ = world_->create_shape(BoxShape{}).value();
        const ShapeHandle plane = world_->create_shape(PlaneShape{}).value();
        ASSERT_TRUE(world_->create_body({.kind = BodyKind::static_body, .shape = plane}));
        for (int i = 0; i < 6; ++i) cubes_.push_back(add_cube({(i / 2) * 5.0, 0.5 + i % 2, 0}));
        for (int i = 0; i < 120; ++i) world_->step();
        ASSERT_EQ(world_->last_report().bodies_asleep, 6u);
    }
    BodyHandle add_cube(Vec3 place, bool asleep = false) {
        return world_->create_body({.shape = cube_, .position = place, .start_asleep = asleep}).value();
    }

    std::unique_ptr<World> world_;
    ShapeHandle cube_;
    std::vector<BodyHandle> cubes_;
};

TEST_F(SleepingWorld, stays_as_it_is_bit_for_bit) {
    const std::uint64_t before = world_->state_hash();
    const double time = world_->last_report().time;
    for (int i = 0; i < 10; ++i) {
        const StepReport& report = world_->step();
        EXPECT_EQ(report.bodies_asleep, 6u);
        EXPECT_EQ(report.bodies_active + report.bodies_wanting_to_sleep, 0u);
        EXPECT_TRUE(world_->sleep_events().empty());
        EXPECT_TRUE(world_->contact_events().empty());
    }
    EXPECT_EQ(world_->state_hash(), before);
    EXPECT_NEAR(world_->last_report().time - time, 10.0 / 60, 1e-12);
    EXPECT_EQ(world_->contacts().size(), 24u);  // four points a cube
}

TEST_F(SleepingWorld, wakes_column_by_column_and_counts_the_rest) {
    ASSERT_TRUE(world_->apply_impulse(cubes_[1], {100, 0, 0}));
    EXPECT_EQ(world_->step().bodies_asleep, 4u);
    EXPECT_EQ(world_->last_report().bodies_active + world_->last_report().bodies_wanting_to_sleep, 2u);
    EXPECT_GT(world_->linear_velocity(cubes_[1]).x, 0);
    EXPECT_EQ(world_->linear_velocity(cubes_[3]), Vec3{});

    // And sleeps again.
    for (int i = 0; i < 120; ++i) world_->step();
    EXPECT_EQ(world_->last_report().bodies_asleep, 6u);
}

TEST_F(SleepingWorld, notices_what_the_user_adds_and_takes_away) {
    // The upper cube falls when the lower one goes.
    ASSERT_TRUE(world_->destroy_body(cubes_[0]));
    world_->step();
    EXPECT_EQ(world_->last_report().bodies_asleep, 4u);
    EXPECT_LT(world_->linear_velocity(cubes_[1]).y, -0.1);

    // Disabled ones are not counted; new ones are, asleep or not.
    for (int i = 0; i < 240; ++i) world_->step();
    EXPECT_EQ(world_->last_report().bodies_asleep, 5u);
    ASSERT_TRUE(world_->set_enabled(cubes_[1], false));
    EXPECT_EQ(world_->step().bodies_asleep, 4u);
    add_cube({0, 0.5, 20}, true);
    EXPECT_EQ(world_->step().bodies_asleep, 5u);
    const BodyHandle falling = add_cube({0, 5, 30});
    EXPECT_EQ(world_->step().bodies_active, 1u);
    EXPECT_LT(world_->linear_velocity(falling).y, 0);
}

TEST_F(SleepingWorld, wakes_where_something_falls_on_it) {
    add_cube({0, 4, 0});
    bool woke = false;
    for (int i = 0; i < 60 && !woke; ++i) {
        world_->step();
        woke = world_->sleep_state(cubes_[1]) != SleepState::asleep;
    }
    EXPECT_TRUE(woke);
    EXPECT_EQ(world_->last_report().bodies_asleep, 4u);
}

// A hand that moves things while no step comes names the same ones again and again.
TEST(ToWake, RemembersEachBodyToWakeABoundedNumberOfTimes) {
    ActivityState activity;
    activity.sleep.resize(100);
    std::vector<std::uint32_t> named;
    for (std::uint32_t i = 0; i < 100; ++i) named.push_back(i);
    for (int iteration = 0; iteration < 1000; ++iteration)
        for (const std::uint32_t body : named) wake_later(activity, body);
    EXPECT_LE(activity.to_wake.size(), 2 * named.size() + 64);
    EXPECT_EQ(std::set<std::uint32_t>(activity.to_wake.begin(), activity.to_wake.end()).size(), named.size());
    EXPECT_EQ(activity.to_wake.front(), named.front());
}

}  // namespace
}  // namespace embody::physics::stages
