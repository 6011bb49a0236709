// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "server/certificate.h"
#include "server/library_fill.h"
#include "server/scene_thread.h"

namespace embody::server {

struct ServerOptions {
    std::string address = "127.0.0.1";    ///< with any other address url() ends with a token, which clients need
    unsigned short port = 8420;           ///< 0: any free one
    bool any_port_if_taken = true;        ///< take a free port where `port` is in use
    std::filesystem::path studio_folder;  ///< the built front-end
    std::optional<CertificateFiles> certificate = {};  ///< HTTPS with these; plain HTTP is sent there
    SceneThreadOptions scene;
    FillOptions fill;  ///< what is imported in the background
};

/// Serves the Studio, the models and one open scene to browsers and scripts (docs/protocol.md).
class Server {
public:
    /// The server listens when this returns.
    static Result<std::unique_ptr<Server>> start(const ServerOptions& options);
    /// Closes all connections and stops the scene.
    ~Server();

    /// The Studio's address, with the token where one is needed.
    [[nodiscard]] std::string url() const;
    /// One of this machine's addresses in its networks, with the token for each kind of guest.
    struct Addresses {
        std::string build;  ///< who comes by it may do everything
        std::string run;    ///< look, play and pull
        std::string look;
    };
    /// For other machines; none where it listens on loopback only.
    [[nodiscard]] std::vector<Addresses> urls_for_others() const;
    /// Serves until request_stop() or SIGINT or SIGTERM.
    void run();
    /// May be called from any thread.
    void request_stop();
    /// After run(): ends all that is still running. True: everything has ended in this time, and the server can be
    /// destroyed. False: something does not end, for example a step of a huge scene or the import of a model. Then
    /// uploads are removed, and the process should end without destroying the server, which would wait; every edit is
    /// in the journal already.
    bool end_within(std::chrono::milliseconds time);

private:
    Server();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::server
