// SPDX-License-Identifier: MIT
#include "scene/session/session.h"

#include <map>
#include <nlohmann/json.hpp>

#include "scene/file/scene_file.h"
#include "scene/file/whole_file.h"
#include "scene/session/catalog_edit.h"
#include "scene/session/commands/commands.h"
#include "scene/session/presence.h"
#include "scene/session/scene_folders.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// All commands by name.
const std::map<std::string, const Command*>& command_table() {
    static const std::map<std::string, const Command*> table = [] {
        std::map<std::string, const Command*> built;
        for (const auto family : {catalog_commands(), catalog_change_commands(), scene_commands(), people_commands(),
                                  entity_commands(), placement_commands(), room_commands(), arrange_commands(),
                                  group_commands(), part_commands(), attribute_commands(), value_commands(),
                                  joint_and_action_commands(), simulation_commands(), time_commands()})
            for (const Command& command : family) built[command.name] = &command;
        return built;
    }();
    return table;
}

// Of the moment what is in the document or was spawned: other things were removed since.
void append_states(const SessionState& session, const Moment& moment, std::vector<EntityState>& states) {
    for (const EntityMoment& was : moment.entities) {
        if (!session.is_known(was.motion.entity)) continue;
        EntityState& state = states.emplace_back();
        state.entity = was.motion.entity;
        state.pose = was.motion.pose;
        state.state = was.motion.state;
        state.points = was.motion.points;
        state.jump = session.past.jumps;
    }
}

Error unknown_command(const std::string& name) {
    std::vector<std::string> known;
    for (const auto& [command, entry] : command_table()) known.push_back(command);
    const std::string nearest = nearest_word(name, known);
    return {"command", "\"" + name.substr(0, 80) + "\" is not a command",
            nearest.empty() ? "" : "did you mean \"" + nearest + "\"?"};
}

}  // namespace

struct Session::State : SessionState {
    using SessionState::SessionState;
};

Session::Session() = default;
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::create(catalog::Catalog* catalog, const SessionOptions& options) {
    // Drafts that killed programs left half written.
    for (const std::filesystem::path& folder : {options.saved_scenes, options.saved_scenes / "autosave"})
        remove_abandoned_drafts(folder);
    std::unique_ptr<Session> session(new Session);
    session->state_ = std::make_unique<State>(catalog, options);
    if (Result<void> opened = session->state_->open(new_document("Untitled"), ""); !opened.ok()) return opened.error();
    session->state_->events = {};
    return session;
}

Result<json> Session::execute(const std::string& command, const json& params, ClientId client) {
    const auto found = command_table().find(command);
    if (found == command_table().end()) return unknown_command(command);
    // A command without parameters may leave them out.
    static const json nothing = json::object();
    state_->client = client;
    if (Result<void> allowed = check_rights(*state_, found->second->need, found->second->name); !allowed.ok())
        return allowed.error();
    return found->second->execute(*state_, params.is_null() ? nothing : params);
}

void Session::admit(ClientId client, Rights rights) { state_->people.client(client).rights = rights; }

void Session::forget_client(ClientId client) {
    state_->forget_hands(client);
    const auto known = state_->people.clients().find(client);
    if (known != state_->people.clients().end() && !known->second.is_member)
        state_->history.forget(known->second.person);
    if (!state_->people.leave(client)) return;
    state_->tell({{"event", "members"}, {"members", state_->people.members()}});
    scene::follow_question(*state_, std::chrono::steady_clock::now());
}

void Session::follow_people(std::chrono::steady_clock::time_point now) {
    scene::follow_question(*state_, now);
    tell_presences(*state_, now);
}

bool Session::follow_catalog() {
    const bool has_changed = follow_changes_of_others(*state_);
    return state_->follow_arrivals() || has_changed;
}

std::set<std::string> Session::missing_models() const {
    std::set<std::string> keys;
    for (const EntityIndex index : state_->simulation->waiting())
        if (const Entity* entity = state_->document.find(index))
            keys.insert(std::get<ModelReference>(entity->geometry).key);
    return keys;
}

Events Session::take_events() {
    state_->tell_waiting();
    return std::exchange(state_->events, {});
}

const Document& Session::document() const { return state_->document; }
bool Session::playing() const { return state_->play_state == PlayState::playing; }
double Session::time_step() const { return state_->document.settings.time_step; }
double Session::rate() const { return state_->past.rate; }
void Session::step() { state_->step(); }

void Session::read_states(std::vector<EntityState>& states) const {
    states.clear();
    if (state_->past.shown) return append_states(*state_, *state_->past.shown, states);
    const Simulation& simulation = *state_->simulation;
    for (const EntityIndex index : simulation.entities()) {
        EntityState& state = states.emplace_back();
        state.entity = index;
        state.pose = simulation.pose(index);
        if (simulation.is_movable(index)) state.state = static_cast<std::uint8_t>(simulation.sleep_state(index));
        state.points = simulation.points(index);
        state.jump = state_->past.jumps;
    }
}

void Session::read_states_at(std::optional<double> time, std::vector<EntityState>& states, Moment& moment) const {
    if (!time || state_->past.take.empty()) return read_states(states);
    moment = state_->past.take.at(*time);
    states.clear();
    append_states(*state_, moment, states);
}

const Entity* Session::spawned(EntityIndex index) const {
    const auto found = state_->past.spawned.find(index);
    return found == state_->past.spawned.end() ? nullptr : &found->second.entity;
}

physics::DebugDrawCount Session::debug_draw(physics::DebugDraw& draw, const physics::DebugDrawOptions& options) const {
    return state_->simulation->world().debug_draw(draw, options);
}

double Session::simulated_time() const { return state_->shown_time(); }
std::uint64_t Session::simulated_steps() const { return state_->shown_step(); }

json Session::statistics() const {
    const physics::StepReport& report = state_->simulation->world().last_report();

    const Activity activity = state_->simulation->activity();

    // Simulated time over real time of the last steps.
    double factor = 0;
    if (state_->play_state == PlayState::playing && state_->step_times.size() > 1) {
        const std::chrono::duration<double> passed = state_->step_times.back() - state_->step_times.front();
        const double simulated = static_cast<double>(state_->step_times.size() - 1) * time_step();
        if (passed.count() > 0) factor = simulated / passed.count();
    }
    return {{"event", "statistics"},
            {"time", state_->shown_time()},
            {"step", state_->shown_step()},
            {"bodies", state_->simulation->entities().size()},
            {"things", activity.things},
            {"active", activity.active},
            {"wants_to_sleep", activity.wants_to_sleep},
            {"asleep", activity.asleep},
            {"points", activity.points},
            {"contacts", report.contacts},
            {"step_ms", report.milliseconds},
            {"real_time_factor", factor}};
}

}  // namespace embody::scene
