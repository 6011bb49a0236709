// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "foundation/result.h"
#include "scene/session/session.h"

namespace embody::server {

/// What of the solver's internal state each client has chosen to see, and the newest frame of it (docs/protocol.md,
/// "Debug frames"). The scene thread chooses and publishes; the network thread takes.
class DebugBoard {
public:
    /// The command debug.draw: from now on the client receives what `show` of its parameters names; of the entities in
    /// `of` alone where that is there.
    Result<void> choose(scene::ClientId client, const nlohmann::json& params);
    /// Removes a client that has left.
    void forget(scene::ClientId client);
    [[nodiscard]] bool is_wanted() const;
    /// Draws a new frame for all clients that chose something; it replaces a frame that a client has not taken.
    void publish(const scene::Session& session);
    /// The client's newest frame, once; null: none.
    std::shared_ptr<const std::string> take(scene::ClientId client);

private:
    struct Wish {
        std::uint32_t flags = 0;          ///< physics::DebugDrawFlag
        std::vector<std::uint64_t> only;  ///< entities, ascending; empty: all
        std::shared_ptr<const std::string> frame;
    };
    mutable std::mutex mutex_;
    std::map<scene::ClientId, Wish> wishes_;
};

}  // namespace embody::server
