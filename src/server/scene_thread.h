// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "foundation/result.h"
#include "scene/session/session.h"
#include "server/state_frame.h"

namespace embody::server {

using scene::ClientId;

struct SceneThreadOptions {
    std::filesystem::path database;  ///< the thread opens a Catalog of its own
    std::filesystem::path taxonomy_folder;
    scene::SessionOptions session;
    /// What the transport adds to the answer to the `hello` of a client with these rights; called on the scene thread.
    /// May be empty.
    std::function<nlohmann::json(const scene::Rights&)> greeting = {};
    std::string open_scene;  ///< name of a saved or demo scene, or a path; empty: an empty scene
};

/// What the scene thread reports to the transport. Called on the scene thread; the transport posts it to its own
/// thread.
struct SceneThreadListener {
    std::function<void(ClientId, std::string reply)> reply;
    std::function<void(std::string event)> broadcast;
    std::function<void(ClientId, std::string event)> send;  ///< to one client, in order with replies and broadcasts
    std::function<void()> states_changed;
};

/// Runs the session on a thread of its own: executes commands in the order of their arrival, steps in real time while
/// playing, publishes states. Thread-safe; only the destructor waits for the current command.
class SceneThread {
public:
    static Result<std::unique_ptr<SceneThread>> start(const SceneThreadOptions& options, SceneThreadListener listener);
    /// Stops after the current command.
    ~SceneThread();

    /// A text message of a client, unparsed. Exactly one reply will follow.
    void post(ClientId client, std::string message);

    /// What a client may do; before its first message.
    void admit(ClientId client, scene::Rights rights);

    /// Forgets a client that has left, and its user's name.
    void forget(ClientId client);

    [[nodiscard]] StateBoard::Frame frame_since(std::uint64_t seen) const;

    /// The client's newest debug frame, each once; null: nothing new.
    std::shared_ptr<const std::string> take_debug_frame(ClientId client);

    /// Keys of models that the open scene waits for.
    [[nodiscard]] std::set<std::string> missing_models() const;

    /// The open document's title.
    [[nodiscard]] std::string scene_title() const;

    /// Passes a copy of the open document to `take` after the current command, on the scene thread; never calls it
    /// where the thread ends before.
    void request_document(std::function<void(scene::Document)> take);

    /// The thread ends after the current command.
    void request_stop();
    /// Waits until then; returns whether the thread has ended.
    bool wait_ended(std::chrono::steady_clock::time_point until);

private:
    SceneThread();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::server
