// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "foundation/result.h"
#include "server/scene_thread.h"

namespace embody::server {

struct ServerOptions {
    std::string address = "127.0.0.1";    ///< other addresses need the token that url() ends with
    unsigned short port = 8420;           ///< 0: any free one
    bool any_port_if_taken = true;        ///< take a free port where `port` is in use
    std::filesystem::path studio_folder;  ///< the built front-end
    SceneThreadOptions scene;
};

/// Serves the Studio, the models and one open scene to browsers and scripts (docs/protocol.md).
class Server {
public:
    /// Listens when this returns.
    static Result<std::unique_ptr<Server>> start(const ServerOptions& options);
    /// Closes all connections and stops the scene.
    ~Server();

    /// Where a browser finds the Studio, with the token where one is needed.
    [[nodiscard]] std::string url() const;
    /// Serves until request_stop() or SIGINT or SIGTERM.
    void run();
    /// From any thread.
    void request_stop();
    /// After run(): ends all that still works. True: everything has ended in this time, the scene autosaved; the server
    /// can be destroyed. False: something does not end, a step of a huge scene, say, or the import of a model. Then the
    /// scene was autosaved as it was before, uploads are removed, and the process should end without destroying the
    /// server, which would wait. The error: the scene could not be kept.
    Result<bool> end_within(std::chrono::milliseconds time);

private:
    Server();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::server
