// SPDX-License-Identifier: MIT
#include "foundation/state_hash.h"

#include <gtest/gtest.h>

namespace embody {
namespace {

TEST(StateHash, GivesThePublishedNumbersOfFnv1a) {
    StateHash empty, letter, word;
    letter.add_bytes("a", 1);
    word.add_bytes("foobar", 6);
    EXPECT_EQ(empty.value(), 0xCBF29CE484222325ull);
    EXPECT_EQ(letter.value(), 0xAF63DC4C8601EC8Cull);
    EXPECT_EQ(word.value(), 0x85944171F73967E8ull);
}

TEST(StateHash, DistinguishesOrderSignOfZeroAndLastBit) {
    const auto hash = [](double a, double b) {
        StateHash h;
        h.add(a);
        h.add(b);
        return h.value();
    };
    EXPECT_EQ(hash(1, 2), hash(1, 2));
    EXPECT_NE(hash(1, 2), hash(2, 1));
    EXPECT_NE(hash(0.0, 1), hash(-0.0, 1));
    EXPECT_NE(hash(1, 2), hash(1, 2 + 4.5e-16));
}

}  // namespace
}  // namespace embody
