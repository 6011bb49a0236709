// SPDX-License-Identifier: MIT
#include "foundation/random.h"

#include <gtest/gtest.h>

namespace embody {
namespace {

TEST(Random, GivesThePublishedNumbersOfSplitMix64) {
    // The reference implementation's first outputs for the seed 1234567.
    Random random(1234567);
    EXPECT_EQ(random.next(), 6457827717110365317ull);
    EXPECT_EQ(random.next(), 3203168211198807973ull);
    EXPECT_EQ(random.next(), 9817491932198370423ull);
    EXPECT_EQ(random.next(), 4593380528125082431ull);
    EXPECT_EQ(random.next(), 16408922859458223821ull);
}

TEST(Random, UnitIsEvenlySpreadBelowOne) {
    Random random(1);
    double sum = 0, lowest = 1, highest = 0;
    for (int i = 0; i < 100000; ++i) {
        const double x = random.unit();
        sum += x;
        lowest = x < lowest ? x : lowest;
        highest = x > highest ? x : highest;
    }
    EXPECT_NEAR(sum / 100000, 0.5, 0.01);
    EXPECT_GE(lowest, 0);
    EXPECT_LT(lowest, 0.001);
    EXPECT_GT(highest, 0.999);
    EXPECT_LT(highest, 1);
}

TEST(Random, BetweenAndBelowKeepTheirRanges) {
    Random random(2);
    std::uint64_t seen = 0;
    for (int i = 0; i < 1000; ++i) {
        const double x = random.between(-3, -2);
        EXPECT_TRUE(x >= -3 && x < -2);
        const std::uint64_t k = random.below(5);
        ASSERT_LT(k, 5u);
        seen |= 1ull << k;
    }
    EXPECT_EQ(seen, 31u);
}

}  // namespace
}  // namespace embody
