// SPDX-License-Identifier: MIT
#include "server/connection_book.h"

#include <gtest/gtest.h>

#include <vector>

namespace embody::server {
namespace {

constexpr ConnectionLimits small{.all = 4, .per_address = 3, .viewers = 2};

TEST(ConnectionBook, RefusesWhereAllAreBusy) {
    ConnectionBook book(small);
    std::vector<ConnectionBook::Place> places;
    for (int i = 0; i < 3; ++i) places.push_back(*book.admit("10.0.0.1"));
    EXPECT_FALSE(book.admit("10.0.0.1")) << "a fourth of one address";
    places.push_back(*book.admit("10.0.0.2"));
    EXPECT_FALSE(book.admit("10.0.0.3")) << "a fifth in all";
    places.pop_back();
    EXPECT_TRUE(book.admit("10.0.0.3")) << "one has gone";
}

TEST(ConnectionBook, TheLongestIdleOfTheSameAddressMakesRoom) {
    ConnectionBook book(small);
    std::vector<int> given_up;
    std::vector<ConnectionBook::Place> places;
    places.push_back(*book.admit("10.0.0.2"));
    places.back().be_idle([&] { given_up.push_back(0); });
    for (int i = 1; i <= 3; ++i) {
        places.push_back(*book.admit("10.0.0.1"));
        places.back().be_idle([&given_up, i] { given_up.push_back(i); });
    }
    places[1].be_busy();
    auto newcomer = book.admit("10.0.0.1");
    ASSERT_TRUE(newcomer);
    EXPECT_EQ(given_up, std::vector{2}) << "1 is busy, 0 is another client's";
    // The limit of all addresses: the connection that has been idle for longest makes room.
    auto stranger = book.admit("10.0.0.3");
    ASSERT_TRUE(stranger);
    EXPECT_EQ(given_up, (std::vector{2, 0}));
    // The closed connection has no entry any more, and its calls do nothing.
    places[2].be_busy();
    EXPECT_FALSE(places[2].become_viewer());
}

TEST(ConnectionBook, ViewersHaveALimitOfTheirOwn) {
    ConnectionBook book(small);
    auto a = book.admit("10.0.0.1"), b = book.admit("10.0.0.1"), c = book.admit("10.0.0.1");
    EXPECT_TRUE(a->become_viewer());
    EXPECT_TRUE(b->become_viewer());
    EXPECT_FALSE(c->become_viewer());
    a.reset();
    EXPECT_TRUE(c->become_viewer());
}

TEST(ConnectionBook, LeavesDescriptorsForFiles) {
    for (const std::size_t descriptors : {64u, 256u, 1024u, 4096u}) {
        const ConnectionLimits limits = limits_for_descriptors(descriptors);
        EXPECT_GE(limits.per_address, 8u);
        EXPECT_LE(limits.per_address, limits.all);
        EXPECT_LE(limits.viewers, limits.all);
        if (descriptors >= 256) {
            EXPECT_LE(limits.all + 100, descriptors);
        }
    }
}

}  // namespace
}  // namespace embody::server
