// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "foundation/result.h"
#include "scene/session.h"

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
/// playing, publishes states. Thread-safe.
class SceneThread {
public:
    static Result<std::unique_ptr<SceneThread>> start(const SceneThreadOptions& options, SceneThreadListener listener);
    /// Stops after the command in hand; autosaves.
    ~SceneThread();

    /// A text message of a client, as it came. Exactly one reply will follow.
    void post(ClientId client, std::string message);

    /// A client has left: what it was called is forgotten.
    void forget(ClientId client);

    /// Binary frame of what changed after version `seen`, and the version it brings the client to.
    struct Frame {
        std::string bytes;  ///< empty: nothing new
        std::uint64_t version = 0;
    };
    [[nodiscard]] Frame frame_since(std::uint64_t seen) const;

    /// The open document's title; does not wait for the command in hand.
    [[nodiscard]] std::string scene_title() const;

    /// The open document as a scene file.
    [[nodiscard]] std::string scene_json() const;

private:
    SceneThread();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::server
