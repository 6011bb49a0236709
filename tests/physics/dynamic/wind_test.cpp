// SPDX-License-Identifier: MIT
#include "physics/dynamic/wind.h"
#include "make_world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics::dynamic {
namespace {

TEST(Wind, IsSteadyWithoutGusts) {
    const Wind wind{.mean = {3, 0, -1}, .time = 12.3};
    EXPECT_FALSE(wind.is_gusty());
    EXPECT_EQ(wind.at({1, 2, 3}), wind.mean);
    const Wind still{.gustiness = 0.5, .time = 12.3};
    EXPECT_FALSE(still.is_gusty());
    EXPECT_EQ(still.at({}), Vec3{});
}

TEST(Wind, GustsHaveTheMeanAndTheStrengthThatTheyAreGiven) {
    Wind wind{.mean = {0, 0, 5}, .gustiness = 0.3};
    Vec3 mean, squares;
    const int count = 100'000;
    for (int i = 0; i < count; ++i) {
        wind.time = 0.05 * i;
        const Vec3 change = wind.at({0.37 * (i % 101), 0.23 * (i % 53), 0}) - wind.mean;
        mean += change / count;
        squares += scale(change, change) / count;
    }
    EXPECT_LT(length(mean), 0.05);
    EXPECT_NEAR(std::sqrt(squares.z), 1.5, 0.06);
    EXPECT_NEAR(std::sqrt(squares.x), 1.5 * 0.8, 0.05);
    EXPECT_NEAR(std::sqrt(squares.y), 1.5 * 0.52, 0.03);
}

TEST(Wind, GustsAreSmoothInTimeAndPlaceAndCarriedAlong) {
    const auto at = [](double time, Vec3 place) { return Wind{{4, 0, 0}, 0.5, 1, time}.at(place); };
    for (int i = 0; i < 1000; ++i) {
        EXPECT_LT(length(at(0.001 * (i + 1), {}) - at(0.001 * i, {})), 0.1) << i;
        EXPECT_LT(length(at(3, {0, 0, 0.001 * (i + 1)}) - at(3, {0, 0, 0.001 * i})), 0.1) << i;
    }
    // What is here now is 4 m further downwind a second later.
    for (int i = 0; i < 20; ++i) EXPECT_LT(length(at(i + 1, {4, 1, 2}) - at(i, {0, 1, 2})), 1e-9) << i;
    double changed = 0;
    for (int i = 0; i < 20; ++i) changed += length(at(i, {0, 0, 2}) - at(i, {})) / 20;
    EXPECT_GT(changed, 0.5) << "2 m aside it blows otherwise";
    EXPECT_EQ(at(77.7, {1, 2, 3}), at(77.7, {1, 2, 3}));
}

// A strip that hangs in a wind leans so that the air's push and its weight have no moment about the rod.
TEST(Wind, BlowsAHangingSheetAsideAndAnotherWindWakesIt) {
    WorldSettings settings;
    const auto world = make_world(settings);
    DeformableDefinition sheet = cloth_rectangle(0.4, 0.1, 0.05, {.area_density = 0.3, .rayleigh_damping = 0.05});
    // Upright: its X is the world's -Y.
    sheet.pose = {{0, 0, 0}, from_axis_angle({0, 0, 1}, -std::acos(-1.0) / 2)};
    for (std::uint32_t i = 0; i < sheet.nodes.size(); ++i)
        if (sheet.nodes[i].x < -0.199) sheet.pinned.push_back(i);
    const auto handle = world->create_deformable(sheet);
    ASSERT_TRUE(handle);
    for (int i = 0; i < 240; ++i) world->step();
    EXPECT_TRUE(world->is_asleep(*handle));
    EXPECT_NEAR(world->center_of_mass(*handle).x, 0, 1e-3);
    settings.wind = {3, 0, 0};
    ASSERT_TRUE(world->set_settings(settings));
    EXPECT_FALSE(world->is_asleep(*handle));
    for (int i = 0; i < 600; ++i) world->step();
    // A flat one leans by θ with ρ/2 C v² cos²θ = w g sin θ, 6.48 cos²θ = 2.94 sin θ: θ = 53°.
    const Vec3 center = world->center_of_mass(*handle);
    EXPECT_GT(center.x, 0.05);
    settings.gustiness = 0.3;
    ASSERT_TRUE(world->set_settings(settings));
    for (int i = 0; i < 240; ++i) {
        world->step();
        EXPECT_FALSE(world->is_asleep(*handle));
    }
}

}  // namespace
}  // namespace embody::physics::dynamic
