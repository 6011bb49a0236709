// SPDX-License-Identifier: MIT
#include "server/scene_thread.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

namespace embody::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A scene thread on an empty database, and the replies of its one client.
class SceneThreadTest : public testing::Test {
protected:
    SceneThreadTest() {
        std::string name = (fs::temp_directory_path() / "embody-scene-thread-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        SceneThreadOptions options;
        options.database = folder_ / "models.sqlite";
        options.taxonomy_folder = fs::path(EMBODY_SOURCE_DIR) / "data" / "taxonomy";
        options.session.saved_scenes = folder_ / "saved";
        options.session.demo_scenes = folder_ / "demo";
        SceneThreadListener listener;
        listener.reply = [this](ClientId, const std::string& text) {
            const std::lock_guard lock(mutex_);
            replies_.push_back(text);
            changed_.notify_all();
        };
        listener.broadcast = [](const std::string&) {};
        listener.states_changed = [] {};
        auto started = SceneThread::start(options, listener);
        if (started)
            thread_ = std::move(*started);
        else
            ADD_FAILURE() << started.error().message();
    }
    ~SceneThreadTest() override {
        thread_.reset();
        fs::remove_all(folder_);
    }

    json ask(std::string message) {
        thread_->post(1, std::move(message));
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !replies_.empty(); });
        const json reply = json::parse(replies_.front());
        replies_.pop_front();
        return reply;
    }

    fs::path folder_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::string> replies_;
    std::unique_ptr<SceneThread> thread_;
};

TEST_F(SceneThreadTest, WhatIsNoCommandIsRefused) {
    for (const char* message : {"", "{", "[]", "null", "\xff", R"({"id": "a", "command": "hello"})",
                                R"({"id": 1e400, "command": "hello"})", R"({"id": 1})"})
        EXPECT_EQ(ask(message).at("ok"), false) << message;
    EXPECT_EQ(ask(R"({"id": 1, "command": "hello", "haste": 1})").at("error").at("where"), "haste");
    EXPECT_EQ(ask(R"({"id": 7, "command": "hello", "params": [1]})").at("error").at("where"), "params");
}

// Copying or freeing such a value walks a level of the stack for each bracket.
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

}  // namespace
}  // namespace embody::server
