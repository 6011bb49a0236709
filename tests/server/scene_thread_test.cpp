// SPDX-License-Identifier: MIT
#include <future>

#include "scene/session/journal.h"
#include "server/scene_thread_fixture.h"

namespace embody::server {
namespace {

using nlohmann::json;

TEST_F(SceneThreadTest, TextThatIsNoCommandIsRefused) {
    for (const char* message : {"", "{", "[]", "null", "\xff", R"({"id": "a", "command": "hello"})",
                                R"({"id": 1e400, "command": "hello"})", R"({"id": 1})"})
        EXPECT_EQ(ask(message).at("ok"), false) << message;
    EXPECT_EQ(ask(R"({"id": 1, "command": "hello", "haste": 1})").at("error").at("where"), "haste");
    EXPECT_EQ(ask(R"({"id": 7, "command": "hello", "params": [1]})").at("error").at("where"), "params");
}

TEST_F(SceneThreadTest, AFieldThatIsWrittenTwiceIsRefused) {
    const json reply = ask(R"({"id": 1, "command": "entity.remove", "params": {"indices": [1], "indices": []}})");
    EXPECT_EQ(reply.at("ok"), false);
    EXPECT_TRUE(reply.at("id").is_null()) << "which of two ids would be meant?";
    EXPECT_EQ(reply.at("error").at("where"), "message, line 1, column 66: params.indices");
}

// Copying or destroying such a value recurses once for each bracket.
TEST_F(SceneThreadTest, AMillionBracketsAreRefusedAndTheServerGoesOn) {
    const std::string open(1'000'000, '['), close(1'000'000, ']');
    for (const std::string& value : {open, open + close}) {
        const json reply = ask(R"({"id": 1, "command": "scene.load", "params": {"scene": )" + value + "}}");
        EXPECT_EQ(reply.at("ok"), false);
        EXPECT_NE(reply.at("error").at("why").get<std::string>().find("64"), std::string::npos);
    }
    EXPECT_EQ(ask(R"({"id": 2, "command": "hello"})").at("ok"), true);
    EXPECT_EQ(
        ask(R"({"id": 3, "command": "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})").at("id"),
        3)
        << "brackets in a text nest nothing";
}

TEST_F(SceneThreadTest, StepsAndResetsReportWhatMoved) {
    run("entity.add",
        {{"entity", {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"pose", {{"position", {0, 3, 0}}}}}}});
    forget_events();
    run("simulation.step", {{"count", 3}});
    std::vector<json> told = events("statistics");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].at("step"), 3);
    EXPECT_EQ(told[0].at("active"), 1);
    EXPECT_EQ(told[0].at("real_time_factor"), 0) << "of single steps there is no rate";
    forget_events();
    run("simulation.reset");
    told = events("statistics");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].at("step"), 0);
}

TEST_F(SceneThreadTest, ATextOfASceneIsOpenedOrItsFileLineAndFieldAreReported) {
    run("scene.load", {{"text", R"({"embody_scene": 1, "title": "Told"})"}, {"file", "told.json"}});
    EXPECT_EQ(run("hello").at("scene").at("title"), "Told");
    const auto refusal = [&](const char* gravity) {
        const std::string text = std::string(R"({"embody_scene": 1, "settings": {"gravity": [0, )") + gravity + "]}}";
        return error_of("scene.load", {{"text", text}, {"file", "told.json"}});
    };
    EXPECT_EQ(refusal("1e999, 0"),
              "told.json, line 1, column 53: settings.gravity[1]: 1e999 is larger than a number can be");
    EXPECT_EQ(refusal("\"a\", 0"), "told.json: settings.gravity[1]: must be a number, got text");
    EXPECT_EQ(error_of("scene.load", {{"text", "{}"}, {"name", "told"}}),
              "name: say either a name, the scene itself, or the text of its file");
    EXPECT_EQ(run("hello").at("scene").at("title"), "Told");
}

TEST_F(SceneThreadTest, WhatStrikesAHandIsToldToItsClientAloneAndALeavingClientLetsGo) {
    const json box = {{"shape", {{"type", "box"}, {"half_extents", {0.1, 0.1, 0.1}}}},
                      {"pose", {{"position", {0, 1, 0}}}},
                      {"attributes", {{"mass", 1}}}};
    const int index = run("entity.add", {{"entity", box}}).at("index");
    run("simulation.listen", {{"impacts", true}}, 2);
    run("simulation.step");
    run("simulation.grab", {{"index", index}, {"point", {0, 1, 0}}, {"target", {0, 0, 0}}, {"hand", "left"}}, 3);
    run("simulation.play");
    const std::vector<json> felt = events_to(3, "hand");
    ASSERT_FALSE(felt.empty());
    EXPECT_EQ(felt[0].at("index"), index);
    EXPECT_EQ(felt[0].at("hand"), "left");
    EXPECT_FALSE(events_to(2, "impacts").empty());
    {
        const std::lock_guard lock(mutex_);
        EXPECT_TRUE(directed_[1].empty());
        EXPECT_EQ(directed_.size(), 3u) << "and nobody else";
    }
    thread_->forget(3);
    EXPECT_EQ(error_of("simulation.move_grab", {{"target", {0, 2, 0}}, {"hand", "left"}}, 3),
              "hand: \"left\" holds nothing: nothing is held, or it was removed");
}

// The network thread asks for these while the scene thread is busy; it must not wait.
TEST_F(SceneThreadTest, TheDocumentArrivesAfterTheCurrentCommandAndTheCallDoesNotWait) {
    thread_->post(1, R"({"id": 1, "command": "simulation.step", "params": {"count": 100000}})");
    std::promise<scene::Document> taken;
    thread_->request_document([&](scene::Document document) { taken.set_value(std::move(document)); });
    // Both calls return at once, though the steps take some seconds.
    (void)thread_->frame_since(0);
    EXPECT_EQ(thread_->scene_title(), "Untitled");
    std::future<scene::Document> document = taken.get_future();
    EXPECT_EQ(next_reply(1).at("ok"), true);
    EXPECT_EQ(document.get().entities.size(), 1u);
}

TEST_F(SceneThreadTest, UnsavedChangesAreOnDiskWhileACommandRuns) {
    run("scene.settings", {{"title", "Kept"}});
    thread_->post(1, R"({"id": 1, "command": "simulation.step", "params": {"count": 100000}})");
    const std::filesystem::path journals = folder_ / "saved" / "autosave";
    ASSERT_FALSE(std::filesystem::is_empty(journals));
    const auto kept = scene::read_journal(std::filesystem::directory_iterator(journals)->path());
    ASSERT_TRUE(kept.ok()) << kept.error().message();
    EXPECT_EQ(kept.value().document.title, "Kept");
    thread_->request_stop();
    EXPECT_TRUE(thread_->wait_ended(std::chrono::steady_clock::now() + std::chrono::seconds(60)));
}

}  // namespace
}  // namespace embody::server
