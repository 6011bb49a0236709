// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "physics/inter/debug_draw.h"
#include "scene/document/document.h"
#include "scene/matter/moving_points.h"

namespace embody::scene {

/// What a client must be told after a command or a step, as the protocol's events.
struct Events {
    std::vector<nlohmann::json> messages;  ///< in order, for every client
    bool all_poses = false;                ///< send every entity's pose again
    std::size_t actions = 0;               ///< carried out; of very many the later ones have no message
};

/// One entity's state for a state frame.
struct EntityState {
    EntityIndex entity = 0;
    Transform pose;
    std::uint8_t state = 3;                ///< 0 active, 1 wants to sleep, 2 asleep, 3 static or kinematic
    const MovingPoints* points = nullptr;  ///< of what is not one body; valid until the next command or step
};

/// Numbers a connection for as long as the program runs; 0: the program itself.
using ClientId = std::uint64_t;

struct SessionOptions {
    std::filesystem::path saved_scenes;      ///< folder of the user's scenes; autosaves go to its sub-folder "autosave"
    std::filesystem::path demo_scenes;       ///< folder of the scenes that come with Embody
    std::function<bool()> stop_wanted = {};  ///< asked between the steps of simulation.step; true ends it early
    /// Told now and then how far the command in hand is; false ends it, and nothing is changed. May be empty.
    std::function<bool(std::size_t done, std::size_t total)> progress = {};
};

/// One open scene: the document with undo, its running simulation, and every command of docs/protocol.md that is not
/// the transport's. Used by one thread.
class Session {
public:
    /// `catalog` may be null (scenes of primitives only); it outlives the session.
    static Result<std::unique_ptr<Session>> create(catalog::Catalog* catalog, const SessionOptions& options);
    ~Session();

    /// Carries out a command of docs/protocol.md for a client; the value is its `result`.
    Result<nlohmann::json> execute(const std::string& command, const nlohmann::json& params, ClientId client = 0);
    /// A client has left.
    void forget_client(ClientId client);
    /// Takes up what other programs changed in the catalogue, and tells whether there was any; for a timer.
    bool follow_catalog();
    /// What happened since the last call.
    Events take_events();

    [[nodiscard]] const Document& document() const;
    [[nodiscard]] bool playing() const;
    [[nodiscard]] double time_step() const;
    /// One step of the simulation, with actions; pauses where an action says so.
    void step();
    /// Every entity's pose and state now (spawned ones too).
    void read_states(std::vector<EntityState>& states) const;
    /// World::debug_draw() of the simulation.
    physics::DebugDrawCount debug_draw(physics::DebugDraw& draw, const physics::DebugDrawOptions& options) const;
    [[nodiscard]] double simulated_time() const;
    [[nodiscard]] std::uint64_t simulated_steps() const;
    /// The `statistics` event.
    [[nodiscard]] nlohmann::json statistics() const;
    /// Writes the document beside the saved scenes if it changed since the last call; for a timer.
    Result<void> autosave();
    /// The same from another thread, while a command or step is in hand that does not end: the document as it was
    /// before, if it is not on disk.
    Result<void> rescue();

private:
    Session();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
