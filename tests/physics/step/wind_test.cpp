// SPDX-License-Identifier: MIT
#include "physics/step/wind.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/inter/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

TEST(Wind, IsSteadyWithoutGusts) {
    const WorldSettings settings{.wind = {3, 0, -1}};
    EXPECT_FALSE(is_gusty(settings));
    EXPECT_EQ(wind_at(settings, 12.3), settings.wind);
    EXPECT_FALSE(is_gusty({.gustiness = 0.5}));
    EXPECT_EQ(wind_at({.gustiness = 0.5}, 12.3), Vec3{});
}

TEST(Wind, GustsHaveTheMeanAndTheStrengthThatTheyAreGiven) {
    const WorldSettings settings{.wind = {0, 0, 5}, .gustiness = 0.3, .gust_time = 2};
    Vec3 mean, squares;
    const int count = 200'000;
    for (int i = 0; i < count; ++i) {
        const Vec3 wind = wind_at(settings, 0.05 * i);
        mean += wind / count;
        const Vec3 change = wind - settings.wind;
        squares += scale(change, change) / count;
    }
    EXPECT_LT(length(mean - settings.wind), 0.05);
    EXPECT_NEAR(std::sqrt(squares.z), 1.5, 0.06);
    EXPECT_NEAR(std::sqrt(squares.x), 1.5 * 0.8, 0.05);
    EXPECT_NEAR(std::sqrt(squares.y), 1.5 * 0.52, 0.03);
}

TEST(Wind, GustsAreSmoothAndLastAsLongAsTheyAreTold) {
    WorldSettings settings{.wind = {4, 0, 0}, .gustiness = 0.5, .gust_time = 1};
    for (int i = 0; i < 1000; ++i)
        EXPECT_LT(length(wind_at(settings, 0.001 * (i + 1)) - wind_at(settings, 0.001 * i)), 0.1) << i;
    // The same gusts, slower.
    WorldSettings slow = settings;
    slow.gust_time = 4;
    for (int i = 0; i < 100; ++i) EXPECT_EQ(wind_at(slow, 0.4 * i), wind_at(settings, 0.1 * i)) << i;
    EXPECT_EQ(wind_at(settings, 77.7), wind_at(settings, 77.7));
}

// A strip that hangs in a wind leans so that the air's push and its weight have no moment about the rod.
TEST(Wind, BlowsAHangingSheetAsideAndAnotherWindWakesIt) {
    WorldSettings settings;
    const auto world = World::create(settings).value();
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
}  // namespace embody::physics
