// SPDX-License-Identifier: MIT
#include "scene/session/commands/commands.h"

#include <nlohmann/json.hpp>

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::uint32_t max_steps = 100'000;  // of one command: more would take minutes

Result<void> read_nothing(const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    return {};
}

// A run starts from the same world, independent of earlier edits, so that it is bitwise reproducible.
Result<void> leave_stop(SessionState& state) {
    if (state.play_state != PlayState::stopped || state.simulation_is_pristine) return {};
    return state.rebuild_simulation();
}

Result<json> play(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    if (Result<void> ready = leave_stop(state); !ready.ok()) return ready.error();
    state.set_play_state(PlayState::playing);
    return json::object();
}

Result<json> pause(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    if (state.play_state == PlayState::playing) state.set_play_state(PlayState::paused);
    return json::object();
}

Result<json> step(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t count = 1;
    reader.whole("count", count, 1, max_steps);
    if (!reader.finish()) return *error;
    if (Result<void> ready = leave_stop(state); !ready.ok()) return ready.error();
    state.play_state = PlayState::paused;
    const auto stop_wanted = [&state] { return state.options.stop_wanted && state.options.stop_wanted(); };
    for (std::uint32_t i = 0; i < count && !stop_wanted(); ++i) state.step();
    state.tell(state.simulation_event());
    return json::object();
}

Result<json> reset(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made.error();
    state.play_state = PlayState::stopped;
    state.tell(state.simulation_event());
    state.events.all_poses = true;
    return json::object();
}

Result<json> keep(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    Edit edit = state.start_edit("Keep poses");
    for (const Entity& entity : state.document.entities) {
        if (!state.simulation->contains(entity.index) || entity.locked) continue;
        const Transform pose = state.simulation->pose(entity.index);
        if (pose != entity.pose) edit.changes.emplace_back(PoseChange{entity.index, entity.pose, pose});
    }

    // Now the document has these poses: the run is over.
    state.play_state = PlayState::stopped;
    if (Result<void> kept = state.commit(std::move(edit)); !kept.ok()) return kept.error();
    if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made.error();
    state.tell(state.simulation_event());
    state.events.all_poses = true;
    return json::object();
}

Result<json> grab(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    Vec3 point, target;
    need_index(reader, "index", index);
    need_vector(reader, "point", "the point to hold, in the world", point);
    need_vector(reader, "target", "where to pull it, in the world", target);
    if (!reader.finish()) return *error;
    if (state.play_state == PlayState::stopped)
        return Error{"simulation.grab", "the simulation is stopped", "play first; to move things use entity.transform"};
    const physics::BodyHandle body = state.simulation->hold(index, point);
    if (body.is_null()) return Error{"index", "entity " + std::to_string(index) + " is not in the world"};
    state.grab = Grab{body, inverse_transform_point(state.simulation->world().pose(body), point), target};
    return json::object();
}

Result<json> move_grab(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Vec3 target;
    need_vector(reader, "target", "where to pull it, in the world", target);
    if (!reader.finish()) return *error;
    if (!state.grab) return Error{"simulation.move_grab", "nothing is held", "simulation.grab first"};
    state.grab->target = target;
    return json::object();
}

Result<json> release(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    state.grab.reset();
    state.simulation->let_go();
    return json::object();
}

}  // namespace

std::span<const Command> simulation_commands() {
    static constexpr Command commands[] = {{"simulation.play", play},           {"simulation.pause", pause},
                                           {"simulation.step", step},           {"simulation.reset", reset},
                                           {"simulation.keep", keep},           {"simulation.grab", grab},
                                           {"simulation.move_grab", move_grab}, {"simulation.release", release}};
    return commands;
}

}  // namespace embody::scene
