// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "folders.h"
#include "server/scene_thread.h"

namespace embody::server {

/// A scene thread on an empty database, the replies to its clients, and the events for all clients.
class SceneThreadTest : public testing::Test {
protected:
    using json = nlohmann::json;

    SceneThreadTest() {
        std::string name = (std::filesystem::temp_directory_path() / "embody-scene-thread-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        SceneThreadOptions options;
        options.database = folder_ / "models.sqlite";
        options.taxonomy_folder = source_folder() / "data" / "taxonomy";
        options.session.saved_scenes = folder_ / "saved";
        options.session.demo_scenes = folder_ / "demo";
        SceneThreadListener listener;
        listener.reply = [this](ClientId client, const std::string& text) {
            const std::lock_guard lock(mutex_);
            replies_[client].push_back(text);
            changed_.notify_all();
        };
        listener.broadcast = [this](const std::string& text) {
            const std::lock_guard lock(mutex_);
            events_.push_back(json::parse(text));
            changed_.notify_all();
        };
        listener.send = [this](ClientId client, const std::string& text) {
            const std::lock_guard lock(mutex_);
            directed_[client].push_back(json::parse(text));
            changed_.notify_all();
        };
        listener.states_changed = [] {};
        auto started = SceneThread::start(options, listener);
        if (started)
            thread_ = std::move(*started);
        else
            ADD_FAILURE() << started.error().message();
    }
    ~SceneThreadTest() override {
        thread_.reset();
        std::filesystem::remove_all(folder_);
    }

    /// Sends a message of a client and returns the next reply.
    json ask(std::string message, ClientId client = 1) {
        thread_->post(client, std::move(message));
        return next_reply(client);
    }
    json next_reply(ClientId client) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !replies_[client].empty(); });
        const json reply = json::parse(replies_[client].front());
        replies_[client].pop_front();
        return reply;
    }
    /// Runs a command and returns its result.
    json run(const std::string& command, const json& params = json::object(), ClientId client = 1) {
        const json reply = ask(json{{"id", 1}, {"command", command}, {"params", params}}.dump(), client);
        EXPECT_EQ(reply.at("ok"), true) << command << " " << params.dump() << ": " << reply.dump();
        return reply.value("result", json());
    }
    /// Runs a command and returns its error, in one line.
    std::string error_of(const std::string& command, const json& params = json::object(), ClientId client = 1) {
        const json reply = ask(json{{"id", 1}, {"command", command}, {"params", params}}.dump(), client);
        if (reply.at("ok") == true) return "accepted";
        const json& error = reply.at("error");
        return error.at("where").get<std::string>() + ": " + error.at("why").get<std::string>();
    }
    /// The events of this name so far; waits until there is one.
    std::vector<json> events(const std::string& name) {
        std::unique_lock lock(mutex_);
        std::vector<json> found;
        changed_.wait_for(lock, std::chrono::seconds(20), [&] {
            found.clear();
            for (const json& event : events_)
                if (event.at("event") == name) found.push_back(event);
            return !found.empty();
        });
        return found;
    }
    /// The events of this name for this client alone so far; waits until there is one.
    std::vector<json> events_to(ClientId client, const std::string& name) {
        std::unique_lock lock(mutex_);
        std::vector<json> found;
        changed_.wait_for(lock, std::chrono::seconds(20), [&] {
            found.clear();
            for (const json& event : directed_[client])
                if (event.at("event") == name) found.push_back(event);
            return !found.empty();
        });
        return found;
    }
    void forget_events() {
        const std::lock_guard lock(mutex_);
        events_.clear();
        directed_.clear();
    }

    std::filesystem::path folder_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<ClientId, std::deque<std::string>> replies_;
    std::vector<json> events_;                        ///< for all clients
    std::map<ClientId, std::vector<json>> directed_;  ///< for one client
    std::unique_ptr<SceneThread> thread_;
};

}  // namespace embody::server
