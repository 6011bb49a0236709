// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/session/session_state.h"

namespace embody::scene {
namespace {

TEST(DirectedEvents, AreKeptInOrderBesideThoseForEveryClient) {
    SessionState state(nullptr, {});
    state.tell_to(2, {{"event", "hand"}, {"impulse", 1}});
    state.tell({{"event", "simulation"}});
    state.tell_to(1, {{"event", "hand"}, {"impulse", 2}});
    state.tell_to(2, {{"event", "hand"}, {"impulse", 3}});
    ASSERT_EQ(state.events.messages.size(), 1u);
    ASSERT_EQ(state.events.directed.size(), 3u);
    for (const auto& [place, client] : {std::pair{0, 2u}, {1, 1u}, {2, 2u}}) {
        EXPECT_EQ(state.events.directed[place].first, client);
        EXPECT_EQ(state.events.directed[place].second.at("impulse"), place + 1);
    }
}

}  // namespace
}  // namespace embody::scene
