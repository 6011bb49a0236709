// SPDX-License-Identifier: MIT
// What guests may do: look, run, edit, and say so of others.
#include "scene/session/rights.h"

#include <set>

#include "scene/session/commands/commands.h"
#include "scene/session/session_fixture.h"

namespace embody::scene {
namespace {

using nlohmann::json;

constexpr ClientId host = 1, guest = 2, script = 3;

class RightsTest : public SessionTest {
protected:
    RightsTest() {
        session_->admit(host, {});
        meet(host, "Ann");
        box_ = run(
            "entity.add",
            {{"entity",
              {{"shape", {{"type", "box"}, {"half_extents", {0.1, 0.1, 0.1}}}}, {"pose", {{"position", {0, 1, 0}}}}}}},
            host)["index"];
    }
    void meet(ClientId client, const std::string& name) {
        run("hello", {{"person", name + "'s page"}}, client);
        run("client.set_name", {{"name", name}}, client);
    }
    void come(ClientId client, Rights rights) {
        session_->admit(client, rights);
        meet(client, "Ben");
    }
    Result<json> attempt(ClientId client, const std::string& command, const json& params = json::object()) {
        return session_->execute(command, params, client);
    }
    json rights_of(ClientId client) {
        const json members = run("hello", json::object(), script)["members"];
        for (const json& member : members)
            if (member["client"] == client) return member["rights"];
        return nullptr;
    }

    EntityIndex box_ = 0;
};

// Whoever may only look changes neither document nor run, whatever the command; what only tells is answered.
TEST_F(RightsTest, WhoMayLookChangesNothingByAnyCommand) {
    come(guest, {false, false, false});
    const json before = run("hello", json::object(), host);
    std::set<std::string> refused, answered;
    for (const auto family :
         {catalog_commands(), catalog_change_commands(), scene_commands(), people_commands(), entity_commands(),
          placement_commands(), room_commands(), arrange_commands(), group_commands(), part_commands(),
          attribute_commands(), value_commands(), joint_and_action_commands(), simulation_commands(), time_commands()})
        for (const Command& command : family) {
            const Result<json> done = attempt(guest, command.name);
            const bool is_right = !done.ok() && done.error().why.starts_with("is not allowed");
            (is_right ? refused : answered).insert(command.name);
            EXPECT_EQ(is_right, command.need != Need::look) << command.name;
        }
    EXPECT_GT(refused.size(), 40u);
    const std::set<std::string> telling = {
        "entity.presets",         "entity.warnings", "catalog.categories", "catalog.history", "catalog.model",
        "catalog.search",         "catalog.stop",    "client.present",     "client.set_name", "client.set_rights",
        "entity.attributes",      "entity.copy",     "entity.preview",     "hello",           "entity.collision_shape",
        "entity.simulation_mesh", "scene.answer",    "scene.list",         "scene.pick",      "scene.versions",
        "simulation.listen",      "time.curves",     "time.marks"};
    for (const std::string& name : answered) EXPECT_TRUE(telling.contains(name)) << name << " is open to lookers";
    const json after = run("hello", json::object(), host);
    for (const char* field : {"scene", "revision", "simulation", "undo", "unsaved"})
        EXPECT_EQ(after[field], before[field]) << field;
}

TEST_F(RightsTest, WhoMayRunPlaysAndPullsButDoesNotEdit) {
    come(guest, {false, true, false});
    for (const char* command : {"simulation.play", "simulation.pause", "simulation.step", "simulation.reset"})
        EXPECT_TRUE(attempt(guest, command).ok()) << command;
    run("simulation.step", json::object(), guest);
    EXPECT_TRUE(attempt(guest, "simulation.grab", {{"index", box_}, {"point", {0, 1, 0}}, {"target", {0, 1, 0}}}).ok());
    const Result<json> kept = attempt(guest, "simulation.keep");
    ASSERT_FALSE(kept.ok());
    EXPECT_EQ(kept.error().where, "simulation.keep");
    EXPECT_EQ(kept.error().why, "is not allowed: you may run the scene, but not edit it");
    EXPECT_EQ(kept.error().remedy, "ask Ann");
}

TEST_F(RightsTest, TheHostGivesAndTakesRightsAndEverybodyIsTold) {
    come(guest, {false, false, false});
    (void)session_->take_events();
    run("client.set_rights", {{"client", guest}, {"edit", true}, {"run", false}}, host);
    const Events told = session_->take_events();
    ASSERT_EQ(told.messages.size(), 1u);
    EXPECT_EQ(told.messages[0]["event"], "members");
    ASSERT_EQ(told.directed.size(), 1u);
    EXPECT_EQ(told.directed[0].first, guest);
    EXPECT_EQ(told.directed[0].second["text"], "Ann: you may edit the scene, but not run it");
    EXPECT_TRUE(attempt(guest, "entity.remove", {{"indices", {box_}}}).ok());
    EXPECT_FALSE(attempt(guest, "simulation.play").ok());
    // Their steps stay their own when the right goes; the host can not undo them, and neither can they.
    run("client.set_rights", {{"client", guest}, {"edit", false}, {"run", true}}, host);
    EXPECT_FALSE(attempt(guest, "edit.undo").ok());
    EXPECT_TRUE(attempt(guest, "simulation.play").ok());
}

TEST_F(RightsTest, AreOfThePersonAlsoAfterAReload) {
    come(guest, {false, false, false});
    run("client.set_rights", {{"client", guest}, {"edit", true}, {"run", true}}, host);
    session_->forget_client(guest);
    constexpr ClientId again = 7;
    come(again, {false, false, false});
    EXPECT_EQ(rights_of(again), (json{{"edit", true}, {"run", true}, {"invite", false}}));
    // Another person by the same address has what the address gives.
    constexpr ClientId other = 8;
    session_->admit(other, {false, false, false});
    meet(other, "Eve");
    EXPECT_EQ(rights_of(other), (json{{"edit", false}, {"run", false}, {"invite", false}}));
    // Who comes by the host's address may do everything, whatever was said before.
    constexpr ClientId home = 9;
    come(home, {});
    EXPECT_EQ(rights_of(home), (json{{"edit", true}, {"run", true}, {"invite", true}}));
}

TEST_F(RightsTest, OnlyTheHostGivesThemAndNotOverAHost) {
    come(guest, {true, true, false});
    const json self = {{"client", guest}, {"edit", true}, {"run", true}};
    EXPECT_FALSE(attempt(guest, "client.set_rights", self).ok());
    EXPECT_FALSE(attempt(guest, "client.set_rights", {{"client", host}, {"edit", false}, {"run", false}}).ok());
    EXPECT_FALSE(attempt(host, "client.set_rights", {{"client", host}, {"edit", false}, {"run", false}}).ok());
    EXPECT_FALSE(attempt(host, "client.set_rights", {{"client", 99}, {"edit", false}, {"run", false}}).ok());
    EXPECT_FALSE(attempt(host, "client.set_rights", {{"client", guest}, {"edit", true}}).ok());
    EXPECT_EQ(rights_of(host)["edit"], true);
}

TEST_F(RightsTest, WhatIsHeldIsLetGoWhenTheRightGoes) {
    come(guest, {false, true, false});
    run("simulation.step", json::object(), guest);
    run("simulation.grab", {{"index", box_}, {"point", {0, 1, 0}}, {"target", {0, 3, 0}}}, guest);
    run("simulation.step", {{"count", 240}}, host);
    EXPECT_NEAR(where(box_).y, 3, 0.1);
    run("client.set_rights", {{"client", guest}, {"edit", false}, {"run", false}}, host);
    run("simulation.step", {{"count", 240}}, host);
    EXPECT_LT(where(box_).y, 1) << "what nobody holds falls";
}

TEST_F(RightsTest, WhoMayLookIsNotAskedBeforeAnotherSceneIsOpened) {
    come(guest, {false, true, false});
    EXPECT_EQ(run("scene.new", json::object(), host), json::object());
    // But who may edit is; where the right of who asked goes, nothing is opened.
    run("client.set_rights", {{"client", guest}, {"edit", true}, {"run", true}}, host);
    EXPECT_TRUE(run("scene.new", json::object(), guest).contains("asked"));
    const std::string title = session_->document().title;
    run("client.set_rights", {{"client", guest}, {"edit", false}, {"run", true}}, host);
    session_->follow_people(std::chrono::steady_clock::now() + std::chrono::hours(1));
    EXPECT_EQ(session_->document().title, title);
}

}  // namespace
}  // namespace embody::scene
