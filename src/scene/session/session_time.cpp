// SPDX-License-Identifier: MIT
// The take of a run: what is recorded, what is shown of it, and how a run goes on from it (docs/time.md).
#include <algorithm>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scene/file/scene_file.h"
#include "scene/matter/soft_nodes.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr double marked_speed = 0.3;   // m/s: slower contacts are no event of a run
constexpr double tear_seconds = 0.25;  // s: tears of a sheet that follow each other sooner are one event
constexpr auto told_period = std::chrono::milliseconds(250);

Error no_take(const char* command) {
    return {command, "nothing has been recorded yet", "play first: every run is recorded"};
}

}  // namespace

double SessionState::shown_time() const {
    return past.shown ? past.shown->time : simulation->world().last_report().time;
}

std::uint64_t SessionState::shown_step() const {
    return past.shown ? past.shown->step : simulation->world().last_report().step;
}

bool SessionState::is_known(EntityIndex index) const {
    return past.spawned.contains(index) || document.find(index) != nullptr;
}

std::vector<EntityIndex> SessionState::shown_entities() const {
    if (!past.shown) return simulation->entities();
    std::vector<EntityIndex> shown;
    for (const EntityMoment& was : past.shown->entities)
        if (is_known(was.motion.entity)) shown.push_back(was.motion.entity);
    return shown;
}

void SessionState::record_step() {
    const double time = simulation->world().last_report().time;
    past.take.add(*simulation);
    for (const EntityIndex index : simulation->spawned())
        if (const Entity* entity = simulation->definition(index)) past.spawned[index] = {*entity, time};
    for (const EntityIndex index : simulation->despawned()) past.removed[index] = time;
    for (const ThingMelted& melted : simulation->melted()) past.melted[melted.entity] = {melted.liquid, time};
    for (const ActionFired& fired : simulation->fired()) {
        past.fired.try_emplace(fired.id, time);
        past.marks.add({time, Mark::Kind::action, fired.sender, fired.receiver, 0, fired.name});
    }
    for (const physics::RopeBreakEvent& broke : simulation->rope_breaks()) {
        const auto rope = static_cast<EntityIndex>(broke.user_data);
        past.breaks.push_back({rope, broke.segment, time});
        past.marks.add({time, Mark::Kind::rope, rope});
    }
    for (const physics::SheetTearEvent& tore : simulation->sheet_tears()) {
        const auto sheet = static_cast<EntityIndex>(tore.user_data);
        if (const SoftNodes* soft = as_soft(simulation->points(sheet)))
            past.add_torn(sheet, time, soft->lasting_deformation().torn_corners);
        const auto is_one_tear = [&](const Mark& mark) {
            return mark.kind == Mark::Kind::tear && mark.a == sheet && mark.time > time - tear_seconds;
        };
        if (std::ranges::none_of(past.marks.all(), is_one_tear)) past.marks.add({time, Mark::Kind::tear, sheet});
    }
    const auto is_marked = [](const physics::ContactEvent& event) {
        return event.user_data_a != event.user_data_b && event.approach_speed >= marked_speed;
    };
    for (const Impact& impact : new_impacts(*simulation, is_marked))
        past.marks.add(
            {time, Mark::Kind::contact, simulation->entity(impact.a), simulation->entity(impact.b), impact.impulse});
    past.marks.cut_before(past.take.start());
    if (std::chrono::steady_clock::now() >= past.told + told_period) tell_take();
}

json SessionState::take_json() const {
    const auto shown = past.shown ? json(past.shown->time) : json(nullptr);
    return {{"start", past.take.start()},
            {"end", past.take.empty() ? 0.0 : simulation->world().last_report().time},
            {"shown", shown},
            {"bytes", past.take.bytes()},
            {"samples", past.take.samples()},
            {"marks", past.marks.revision()}};
}

void SessionState::tell_take() {
    past.told = std::chrono::steady_clock::now();
    json message = take_json();
    message["event"] = "take";
    tell(std::move(message));
}

// Tells what is there then and was not there before, and the reverse.
void SessionState::show(std::optional<Moment> moment) {
    const std::vector<EntityIndex> before = shown_entities();
    past.shown = std::move(moment);
    const std::vector<EntityIndex> now = shown_entities();
    if (before != now) {
        std::vector<EntityIndex> came, gone;
        std::ranges::set_difference(now, before, std::back_inserter(came));
        std::ranges::set_difference(before, now, std::back_inserter(gone));
        for (const EntityIndex index : gone) tell({{"event", "despawned"}, {"index", index}});
        for (const EntityIndex index : came) {
            const auto spawned = past.spawned.find(index);
            const Entity* entity = spawned != past.spawned.end() ? &spawned->second.entity : document.find(index);
            tell_spawned(*entity);
        }
    }
    if (std::chrono::steady_clock::now() >= past.told + told_period) tell_take();
}

Result<void> SessionState::look_at(double time) {
    if (past.take.empty()) return no_take("time.seek");
    set_play_state(PlayState::paused);
    ++past.jumps;
    if (time >= past.take.end())
        look_now();
    else
        show(past.take.at(time));
    tell(simulation_event());
    tell_take();
    return {};
}

void SessionState::look_now() {
    if (!past.shown) return;
    ++past.jumps;
    show({});
    hands.rest();
    tell(simulation_event());
    tell_take();
}

Result<std::vector<std::string>> SessionState::branch() {
    if (past.take.empty()) return no_take("time.branch");
    if (!past.shown) {
        set_play_state(PlayState::paused);
        return std::vector<std::string>();
    }
    const Moment moment = *past.shown;
    const auto is_before = [&](const auto& entry) { return entry.second <= moment.time; };
    Simulation::ActionsDone done;
    for (const auto& [index, spawned] : past.spawned)
        if (spawned.time <= moment.time) done.spawned[index] = spawned.entity;
    for (const auto& entry : past.removed)
        if (is_before(entry)) done.removed.insert(entry.first);
    for (const auto& entry : past.fired)
        if (is_before(entry)) done.fired.insert(entry.first);

    for (const EntityMoment& was : moment.entities) {
        if (!was.points) continue;
        auto torn = past.torn_at(was.motion.entity, moment.time, was.points->count());
        if (!torn.empty()) done.torn[was.motion.entity] = std::move(torn);
    }

    Result<std::unique_ptr<Simulation>> made = Simulation::create(document, catalog, forms, MissingModels::wait);
    if (!made.ok()) return made.error();
    if (Result<void> restored = made.value()->restore_moment(moment, done); !restored.ok()) return restored.error();

    std::vector<std::string> notes;
    const bool ropes = std::ranges::any_of(
        past.marks.all(), [&](const Mark& mark) { return mark.kind == Mark::Kind::rope && mark.time <= moment.time; });
    if (ropes) notes.emplace_back("ropes that had broken are whole again");
    const bool values = std::ranges::any_of(document.actions, [&](const Action& action) {
        return done.fired.contains(action.id) &&
               (std::holds_alternative<SetAttribute>(action.effect) || std::holds_alternative<SetOpen>(action.effect) ||
                std::holds_alternative<SetEnabled>(action.effect) || std::holds_alternative<ApplyForce>(action.effect));
    });
    const bool wires = std::ranges::any_of(moment.entities, [&](const EntityMoment& was) {
        const SoftNodes* before = as_soft(simulation->points(was.motion.entity));
        const SoftNodes* after = as_soft(made.value()->points(was.motion.entity));
        return before != nullptr && after != nullptr &&
               std::holds_alternative<physics::Rope>(after->definition().matter) &&
               before->lasting_deformation().bend != after->lasting_deformation().bend;
    });
    if (wires) notes.emplace_back("wires that had been bent are as at the start again");
    if (values) notes.emplace_back("what actions had set or still pushed is as in the scene again");

    simulation = std::move(made).value();
    simulation_is_pristine = false;
    hands.clear();
    impacts = {};
    past.take.cut(moment.time);
    past.marks.cut_after(moment.time);
    std::erase_if(past.spawned, [&](const auto& entry) { return entry.second.time > moment.time; });
    std::erase_if(past.removed, std::not_fn(is_before));
    std::erase_if(past.melted, [&](const auto& entry) { return entry.second.time > moment.time; });
    std::erase_if(past.fired, std::not_fn(is_before));
    std::erase_if(past.breaks, [&](const Past::Break& broke) { return broke.time > moment.time; });
    for (auto& [sheet, torn] : past.torn) {
        std::erase_if(torn, [&](const Past::Torn& each) { return each.since > moment.time; });
        if (const auto now = done.torn.find(sheet); now != done.torn.end()) torn.back().corners = now->second;
    }
    past.marks.add({moment.time, Mark::Kind::branch});
    ++past.jumps;
    show({});
    past.take.add_now(*simulation);
    play_state = PlayState::paused;
    step_times.clear();
    tell(simulation_event());
    tell_take();
    events.all_poses = true;
    return notes;
}

}  // namespace embody::scene
