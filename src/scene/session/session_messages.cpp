// SPDX-License-Identifier: MIT
// Messages of a session to its clients: progress of the simulation, and changes of the document.
#include <array>
#include <nlohmann/json.hpp>

#include "attributes/form.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/session/kept_forms.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;

namespace {

/// Maximum number of actions told for one command or step: a hundred thousand steps with actions on every contact would
/// fill the memory.
constexpr std::size_t max_told_actions = 1000;

// Message for each limit of a step.
struct LimitText {
    physics::StepLimit limit;
    const char* text;
};
constexpr std::array<LimitText, 9> limit_texts = {{
    {physics::StepLimit::linear_speed_clamped,
     "Something was faster than the scene's greatest speed and was slowed down."},
    {physics::StepLimit::angular_speed_clamped,
     "Something turned faster than the scene's greatest angular speed and was slowed down."},
    {physics::StepLimit::too_many_pairs, "So many things are in each other that some do not see each other."},
    {physics::StepLimit::not_finite_body_frozen,
     "Something's motion left the finite numbers; it was frozen where it was."},
    {physics::StepLimit::not_finite_deformable_frozen,
     "A soft thing's motion left the finite numbers; it was frozen where it was."},
    {physics::StepLimit::not_finite_fluid_frozen,
     "A liquid's motion left the finite numbers; it was frozen where it was."},
    {physics::StepLimit::fluid_particles_lost,
     "Liquid ran so far away that it was taken out; a floor or walls keep it."},
    {physics::StepLimit::impact_iterations_exhausted,
     "An impact was too complicated for one step; a smaller time step helps."},
    {physics::StepLimit::deep_penetration, "Things overlap deeply; place them apart or use a smaller time step."},
}};

const char* state_name(PlayState state) {
    return state == PlayState::stopped ? "stopped" : state == PlayState::playing ? "playing" : "paused";
}

}  // namespace

void SessionState::tell(json message) { events.messages.push_back(std::move(message)); }

void SessionState::tell_to(ClientId recipient, json message) {
    events.directed.emplace_back(recipient, std::move(message));
}

json SessionState::simulation_json() const {
    return {{"state", state_name(play_state)}, {"time", shown_time()}, {"step", shown_step()}, {"rate", past.rate}};
}

json SessionState::simulation_event() const {
    json message = simulation_json();
    message["event"] = "simulation";
    return message;
}

void SessionState::tell_step() {
    const auto name_of = [this](EntityIndex index) {
        const Entity* entity = simulation->definition(index);
        return entity && !entity->name.empty() ? entity->name : "Entity " + std::to_string(index);
    };
    // Effects of actions.
    for (const EntityIndex index : simulation->spawned()) {
        const Entity* entity = simulation->definition(index);
        if (entity) tell_spawned(*entity);
    }
    for (const EntityIndex index : simulation->despawned()) tell({{"event", "despawned"}, {"index", index}});
    for (const ActionFired& fired : simulation->fired()) {
        if (++events.actions > max_told_actions) continue;
        tell({{"event", "action"},
              {"name", fired.name},
              {"id", fired.id},
              {"sender", fired.sender},
              {"receiver", fired.receiver}});
    }

    for (const physics::RopeBreakEvent& broke : simulation->rope_breaks()) {
        const auto index = static_cast<EntityIndex>(broke.user_data);
        const std::string who = name_of(index);
        tell({{"event", "rope_broke"},
              {"index", index},
              {"segment", broke.segment},
              {"tension", broke.tension},
              {"position", vector_to_json(broke.position)}});
        // A rope may break at more places: the first message is enough.
        if (told_problems.insert(who + " broke").second)
            tell_message("warning", who + " broke at a tension of " + attributes::short_number(broke.tension) + " N.");
    }

    for (const physics::SheetTearEvent& tore : simulation->sheet_tears()) {
        const auto index = static_cast<EntityIndex>(tore.user_data);
        const std::string who = name_of(index);
        tell({{"event", "sheet_tore"},
              {"index", index},
              {"nodes", tore.new_nodes},
              {"position", vector_to_json(tore.position)}});
        if (told_problems.insert(who + " tore").second) tell_message("info", who + " tore.");
    }

    // Pieces have the name of the thing, and may break again: one message for each thing of the document, and one for
    // all others of a name.
    for (const ThingBroke& broke : simulation->broke())
        if (told_problems
                .insert((broke.entity > last_document_index ? broke.name : std::to_string(broke.entity)) +
                        " broke into pieces")
                .second)
            tell_message("info", broke.name + " broke into " + std::to_string(broke.pieces) + " pieces by a blow of " +
                                     attributes::short_number(broke.impulse) + " N s.");

    for (const EntityIndex tap : simulation->waiting_taps())
        if (told_problems.insert(std::to_string(tap) + " waits").second)
            tell_message(
                "warning",
                name_of(tap) + ": the tap waits, as its liquid has as many drops as its particle budget allows.");

    // Each problem is told once in a run.
    for (const Error& problem : simulation->problems())
        if (told_problems.insert(problem.message()).second) tell_message("warning", problem.message());
    const std::uint32_t limits = simulation->world().last_report().limits;
    for (const LimitText& row : limit_texts) {
        const auto bit = static_cast<std::uint32_t>(row.limit);
        if ((limits & bit) == 0 || (told_limits & bit) != 0) continue;
        told_limits |= bit;
        tell_message("warning", row.text);
    }
}

void SessionState::tell_message(const char* level, std::string text) {
    tell({{"event", "message"}, {"level", level}, {"text", std::move(text)}});
}

void SessionState::tell_spawned(const Entity& entity) {
    json told = entity_to_json(entity);
    tell_in_short(told);
    tell({{"event", "spawned"}, {"entity", std::move(told)}});
}

void SessionState::tell_document(json changes) {
    tell_changes_in_short(changes, document);
    tell({{"event", "document"},
          {"revision", ++revision},
          {"changes", std::move(changes)},
          {"unsaved", !history.is_saved()},
          {"name", name}});
    tell_histories();
    tell_notes();
}

void SessionState::tell_histories() {
    const auto label = [](const Edit* edit) { return edit ? std::optional(edit->label) : std::nullopt; };
    const auto value = [](const std::optional<std::string>& text) { return text ? json(*text) : json(nullptr); };
    for (auto& [id, told] : people.clients()) {
        const auto undo = label(history.undoable(told.person)), redo = label(history.redoable(told.person));
        if (!told.is_greeted || (told.undo == undo && told.redo == redo)) continue;
        told.undo = undo;
        told.redo = redo;
        tell_to(id, {{"event", "history"}, {"undo", value(undo)}, {"redo", value(redo)}});
    }
}

void SessionState::tell_notes() {
    for (const std::string& note : simulation->notes())
        if (told_notes.insert(note).second) tell_message("warning", note);
}

void SessionState::tell_waiting() {
    std::vector<EntityIndex> waiting = simulation->waiting();
    if (waiting == told_waiting) return;
    told_waiting = std::move(waiting);
    tell({{"event", "waiting"}, {"indices", told_waiting}});
}

void SessionState::tell_waiting_models() {
    const std::size_t count = simulation->waiting().size();
    if (count == 0) return;
    const std::string who =
        count == 1 ? "1 thing waits for its model" : std::to_string(count) + " things wait for their models";
    tell_message("info", who + ", which the database does not have yet. What is imported appears at once.");
}

bool SessionState::follow_arrivals() {
    if (simulation->waiting().empty()) return false;
    const Arrivals arrivals = simulation->take_arrivals();
    if (arrivals.came.empty() && arrivals.refused.empty()) return false;
    simulation_is_pristine = false;
    // While stopped the simulation is made as a document's that has all of this from the start.
    const bool is_rebuilt = !arrivals.refused.empty() && play_state == PlayState::stopped && rebuild_simulation().ok();
    if (!is_rebuilt)
        for (const Error& refused : arrivals.refused)
            tell_message("warning", "Something whose model has come is left out of this run: " + refused.message());
    tell_notes();
    events.all_poses = true;
    return true;
}

}  // namespace embody::scene
