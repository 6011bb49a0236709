// SPDX-License-Identifier: MIT
#include "server/remaining_time.h"

#include <gtest/gtest.h>

#include "foundation/random.h"

namespace embody::server {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto half_second = std::chrono::milliseconds(500);

TEST(RemainingTime, IsExactAtASteadyRateWhateverWasThereBefore) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Random random(seed);
        const std::size_t rate = 1 + random.below(40), there = random.below(1000);  // pieces a half second
        RemainingTime time;
        Clock::time_point now{};
        for (std::size_t i = 0; i <= 40; ++i, now += half_second) time.note(there + i * rate, there, now);
        const std::size_t left = random.below(5000);
        ASSERT_TRUE(time.seconds(left));
        EXPECT_NEAR(*time.seconds(left), 0.5 * static_cast<double>(left) / static_cast<double>(rate), 1e-9 * 5000);
    }
}

TEST(RemainingTime, IsUnknownUntilEnoughIsMeasured) {
    RemainingTime time;
    Clock::time_point now{};
    EXPECT_FALSE(time.seconds(10));
    EXPECT_EQ(time.seconds(0), 0.0);
    // Quick pieces, but for a short time.
    for (std::size_t i = 0; i < 5; ++i, now += half_second) time.note(100 * i, 0, now);
    EXPECT_FALSE(time.seconds(10));
    // Much time, but few pieces.
    RemainingTime slow;
    for (std::size_t i = 0; i < 30; ++i, now += half_second) slow.note(i / 5, 0, now);
    EXPECT_FALSE(slow.seconds(10));
    // What was in the database already says nothing.
    RemainingTime skipping;
    for (std::size_t i = 0; i < 30; ++i, now += half_second) skipping.note(100 * i, 100 * i, now);
    EXPECT_FALSE(skipping.seconds(10));
}

TEST(RemainingTime, FollowsAChangedRateAndDoesNotCountPauses) {
    RemainingTime time;
    Clock::time_point now{};
    std::size_t done = 0;
    for (int i = 0; i < 40; ++i, now += half_second) time.note(done += 10, 0, now);
    EXPECT_NEAR(*time.seconds(200), 10, 1e-9);
    time.pause();
    now += std::chrono::hours(1);
    time.note(done, 0, now);
    EXPECT_NEAR(*time.seconds(200), 10, 0.3) << "an hour's pause";
    for (int i = 0; i < 400; ++i) time.note(done += 1, 0, now += half_second);
    EXPECT_NEAR(*time.seconds(200), 100, 1) << "ten times slower for long";
}

}  // namespace
}  // namespace embody::server
