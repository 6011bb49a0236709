// SPDX-License-Identifier: MIT
#include "scene/session/commands/commands.h"

#include <nlohmann/json.hpp>

#include "scene/session/kept_forms.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::uint32_t max_steps = 100'000;  // of one command: more would take minutes
constexpr std::size_t max_hand_name = 32;     // bytes
/// N: the order of what a person lifts with one arm.
constexpr double usual_strength = 400, min_strength = 1, max_strength = 1e6;
constexpr double min_touch_radius = 0.01, max_touch_radius = 0.3;  // m: a fingertip … a large paddle

Result<void> read_nothing(const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    return {};
}

// A run starts from the same world, independent of earlier edits, so that it is bitwise reproducible.
Result<void> leave_stop(SessionState& state) {
    if (state.play_state != PlayState::stopped) return {};
    if (!state.simulation_is_pristine)
        if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made;
    state.begin_take();
    return {};
}

Result<json> play(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    if (Result<void> ready = leave_stop(state); !ready.ok()) return ready.error();
    if (state.play_state != PlayState::playing) state.hands.rest();
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
    if (!state.past.shown) state.past.take.add_now(*state.simulation);
    state.tell(state.simulation_event());
    state.tell_take();
    return json::object();
}

Result<json> reset(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made.error();
    state.play_state = PlayState::stopped;
    state.tell(state.simulation_event());
    state.tell_take();
    state.events.all_poses = true;
    return json::object();
}

Result<json> keep(SessionState& state, const json& params) {
    if (Result<void> read = read_nothing(params); !read.ok()) return read.error();
    Edit edit = edit_of_shown(state);
    // Now the document begins with what was shown: the run is over.
    state.play_state = PlayState::stopped;
    if (Result<void> kept = state.commit(std::move(edit)); !kept.ok()) return kept.error();
    if (!state.simulation_is_pristine)
        if (Result<void> made = state.rebuild_simulation(); !made.ok()) return made.error();
    state.tell(state.simulation_event());
    state.tell_take();
    state.events.all_poses = true;
    return json::object();
}

// The client's hand that the command is about.
HandName read_hand(FieldReader& reader, const SessionState& state) {
    HandName hand{state.client, "mouse"};
    if (reader.word("hand", hand.name) && hand.name.size() > max_hand_name)
        reader.refuse("hand", "is longer than " + std::to_string(max_hand_name) + " bytes", "such as \"left\"");
    return hand;
}

std::optional<Quat> read_rotation(FieldReader& reader) {
    Quat rotation;
    if (!reader.rotation("rotation", rotation)) return std::nullopt;
    return normalized(rotation);
}

// Hands act on what is now, in a run.
Result<void> check_present(const SessionState& state, const char* command, const char* remedy) {
    if (state.play_state == PlayState::stopped) return Error{command, "the simulation is stopped", remedy};
    if (!state.past.shown) return {};
    return Error{command, "the scene shows what has been", "go on from there with time.branch, or play to the end"};
}

Result<json> grab(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    EntityIndex index = 0;
    Vec3 point;
    HandPlace place;
    double strength = usual_strength;
    need_index(reader, "index", index);
    need_vector(reader, "point", "the point to hold, in the world", point);
    need_vector(reader, "target", "where to pull it, in the world", place.position);
    place.rotation = read_rotation(reader);
    reader.number("strength", strength, {min_strength, max_strength});
    const HandName hand = read_hand(reader, state);
    if (!reader.finish()) return *error;
    if (Result<void> present =
            check_present(state, "simulation.grab", "play first; to move things use entity.transform");
        !present.ok())
        return present.error();
    if (Result<void> held = state.hands.grab(*state.simulation, hand, index, point, strength); !held.ok())
        return held.error();
    state.past.marks.add({state.shown_time(), Mark::Kind::hand, index});
    return done(state.hands.move(*state.simulation, hand, place));
}

Result<json> move_grab(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    HandPlace place;
    need_vector(reader, "target", "where to pull it, in the world", place.position);
    place.rotation = read_rotation(reader);
    const HandName hand = read_hand(reader, state);
    if (!reader.finish()) return *error;
    return done(state.hands.move(*state.simulation, hand, place));
}

Result<json> release(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    const HandName hand = read_hand(reader, state);
    if (!reader.finish()) return *error;
    state.hands.release(*state.simulation, hand);
    return json::object();
}

Result<json> touch(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Hands::Ball ball;
    std::optional<Vec3> position;
    reader.vector("position", position);
    ball.place.rotation = read_rotation(reader);
    reader.number("radius", ball.radius, {min_touch_radius, max_touch_radius});
    const HandName hand = read_hand(reader, state);
    if (!reader.finish()) return *error;
    if (!position) {
        state.hands.stop_touching(*state.simulation, hand);
        return json::object();
    }
    if (Result<void> present = check_present(state, "simulation.touch", "play first: what is stopped cannot be pushed");
        !present.ok())
        return present.error();
    ball.place.position = *position;
    return done(state.hands.touch(*state.simulation, hand, ball));
}

Result<json> listen(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    bool impacts = false;
    if (reader.need("impacts", "true: tell of impacts from now on; false: no more")) reader.truth("impacts", impacts);
    if (!reader.finish()) return *error;
    if (impacts)
        state.impact_listeners.insert(state.client);
    else
        state.impact_listeners.erase(state.client);
    return json::object();
}

}  // namespace

std::span<const Command> simulation_commands() {
    static constexpr Command commands[] = {{"simulation.play", play, Need::run},
                                           {"simulation.pause", pause, Need::run},
                                           {"simulation.step", step, Need::run},
                                           {"simulation.reset", reset, Need::run},
                                           {"simulation.keep", keep},
                                           {"simulation.grab", grab, Need::run},
                                           {"simulation.move_grab", move_grab, Need::run},
                                           {"simulation.release", release, Need::run},
                                           {"simulation.touch", touch, Need::run},
                                           {"simulation.listen", listen, Need::look}};
    return commands;
}

}  // namespace embody::scene
