// SPDX-License-Identifier: MIT
// Cost limits of one command: a client must not be able to fill the memory or to block the session.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/session/session.h"

namespace embody::scene {
namespace {

using nlohmann::json;

TEST(Limits, ManyStepsEndWhereTheOwnerSaysSo) {
    int asked = 0;
    auto session = Session::create(nullptr, {{}, {}, [&asked] { return ++asked > 3; }});
    ASSERT_TRUE(session.ok());
    ASSERT_TRUE((*session)->execute("simulation.step", {{"count", 100}}).ok());
    EXPECT_EQ((*session)->simulated_steps(), 3U);
    EXPECT_FALSE((*session)->playing());
}

TEST(Limits, VeryManyActionsOfOneCommandAreNotAllTold) {
    auto session = Session::create(nullptr, {});
    ASSERT_TRUE(session.ok());
    const json action = {{"trigger", {{"type", "time"}, {"time", 0}, {"repeat_every", 1e-5}}},
                         {"receiver", {{"index", 1}}},
                         {"effect", {{"type", "set_enabled"}, {"enabled", true}}}};
    const auto added = (*session)->execute("action.add", {{"action", action}});
    ASSERT_TRUE(added.ok()) << added.error().message();
    (*session)->take_events();
    ASSERT_TRUE((*session)->execute("simulation.step", {{"count", 1500}}).ok());
    const Events events = (*session)->take_events();
    const auto told = std::count_if(events.messages.begin(), events.messages.end(),
                                    [](const json& message) { return message.at("event") == "action"; });
    EXPECT_EQ(told, 1000);
    EXPECT_EQ(events.actions, 1500U);

    // The next command starts with the full limits.
    ASSERT_TRUE((*session)->execute("simulation.step", {{"count", 2}}).ok());
    EXPECT_EQ((*session)->take_events().actions, 2U);
}

}  // namespace
}  // namespace embody::scene
