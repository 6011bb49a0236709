// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "catalog/catalog.h"
#include "foundation/result.h"
#include "physics/inter/debug_draw.h"
#include "scene/document/document.h"
#include "scene/matter/moving_points.h"
#include "scene/session/rights.h"
#include "scene/simulation/take.h"

namespace embody::scene {

/// Number of a connection, unique while the program runs; 0: the program itself.
using ClientId = std::uint64_t;

/// What clients must be told after a command or a step, as the protocol's events.
struct Events {
    std::vector<nlohmann::json> messages;  ///< in order, for every client
    /// In order, each for one client, who is sent them after the messages for every client.
    std::vector<std::pair<ClientId, nlohmann::json>> directed;
    bool all_poses = false;   ///< send every entity's pose again
    std::size_t actions = 0;  ///< number carried out; of very many the later ones have no message
};

/// One entity's state for a state frame.
struct EntityState {
    EntityIndex entity = 0;
    Transform pose;
    std::uint8_t state = 3;               ///< 0 active, 1 wants to sleep, 2 asleep, 3 static or kinematic
    const ShownPoints* points = nullptr;  ///< of an entity that is not one body; valid until the next command or step
    std::uint64_t jump = 0;               ///< another number: its points may have moved although it slept and sleeps
};

struct SessionOptions {
    std::filesystem::path
        saved_scenes;  ///< folder of the user's scenes; journals go to its sub-folder "autosave". Empty: none is kept
    std::filesystem::path demo_scenes;       ///< folder of the scenes that come with Embody
    std::function<bool()> stop_wanted = {};  ///< called between the steps of simulation.step; true ends it early
    /// Called at intervals with the progress of the running command; false ends it, and nothing is changed. May be
    /// empty.
    std::function<bool(std::size_t done, std::size_t total)> progress = {};
    std::size_t take_bytes = Take::usual_bytes;  ///< maximum size of what is recorded of a run
};

/// One open scene: the document with undo, its running simulation, and every command of docs/protocol.md except those
/// of the transport. Used by one thread.
class Session {
public:
    /// `catalog` may be null (only scenes of primitives); it outlives the session.
    static Result<std::unique_ptr<Session>> create(catalog::Catalog* catalog, const SessionOptions& options);
    ~Session();

    /// Executes a command of docs/protocol.md for a client; the value is its `result`.
    Result<nlohmann::json> execute(const std::string& command, const nlohmann::json& params, ClientId client = 0);
    /// Before a client's first command: what it may do, unless a member has said otherwise for its person. Clients that
    /// nothing was said of may do everything.
    void admit(ClientId client, Rights rights);
    /// A client has left.
    void forget_client(ClientId client);
    /// Opens the scene that members were asked about, once their time to answer is over, and tells presences that came
    /// too fast; for a timer.
    void follow_people(std::chrono::steady_clock::time_point now);
    /// Applies other programs' changes of the catalogue, and takes in what waited for models that have come; returns
    /// whether there was anything. For a timer.
    bool follow_catalog();
    /// Keys of models that entities wait for.
    [[nodiscard]] std::set<std::string> missing_models() const;
    /// Events since the last call.
    Events take_events();

    [[nodiscard]] const Document& document() const;
    [[nodiscard]] bool playing() const;
    [[nodiscard]] double time_step() const;
    /// Simulated seconds that pass in one of the clock's while playing.
    [[nodiscard]] double rate() const;
    /// One step of the simulation, with actions; pauses if an action requests it.
    void step();
    /// Pose and state of every entity (spawned ones too) now, or at the moment of the take that is shown.
    void read_states(std::vector<EntityState>& states) const;
    /// The states at a time of the take, the nearest that it has; without a take, and where there is no time, those
    /// that are shown. `moment` holds their points.
    void read_states_at(std::optional<double> time, std::vector<EntityState>& states, Moment& moment) const;
    /// What an action of this run spawned, also where it is gone; null for others.
    [[nodiscard]] const Entity* spawned(EntityIndex index) const;
    /// World::debug_draw() of the simulation.
    physics::DebugDrawCount debug_draw(physics::DebugDraw& draw, const physics::DebugDrawOptions& options) const;
    /// Of the moment that is shown.
    [[nodiscard]] double simulated_time() const;
    [[nodiscard]] std::uint64_t simulated_steps() const;
    /// The `statistics` event.
    [[nodiscard]] nlohmann::json statistics() const;

private:
    Session();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
