// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
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
    std::string open_scene;  ///< name of a saved or demo scene, or a path; empty: an empty scene
};

/// What the scene thread tells the transport. Called on the scene thread; the transport hands them over to its own.
struct SceneThreadListener {
    std::function<void(ClientId, std::string reply)> reply;
    std::function<void(std::string event)> broadcast;
    std::function<void()> states_changed;
};

/// Runs the session on a thread of its own: carries out commands in the order they came, steps in real time while
/// playing, publishes states. Thread-safe; no call waits for the command in hand but the destructor.
class SceneThread {
public:
    static Result<std::unique_ptr<SceneThread>> start(const SceneThreadOptions& options, SceneThreadListener listener);
    /// Stops after the command in hand; autosaves.
    ~SceneThread();

    /// A text message of a client, as it came. Exactly one reply will follow.
    void post(ClientId client, std::string message);

    /// A client has left: what it was called is forgotten.
    void forget(ClientId client);

    [[nodiscard]] StateBoard::Frame frame_since(std::uint64_t seen) const;

    /// What the client sees of the solver's inside, once a frame; null: nothing new.
    std::shared_ptr<const std::string> take_debug_frame(ClientId client);

    /// The open document's title.
    [[nodiscard]] std::string scene_title() const;

    /// Hands over a copy of the open document after the command in hand, on the scene thread; never where that ends
    /// before.
    void request_document(std::function<void(scene::Document)> take);

    /// It autosaves after the command in hand, and ends.
    void request_stop();
    /// Whether it has ended by then.
    bool wait_ended(std::chrono::steady_clock::time_point until);
    /// For a command that does not end after request_stop(): autosaves the document as it was before.
    Result<void> rescue();

private:
    SceneThread();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::server
