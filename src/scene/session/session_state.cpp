// SPDX-License-Identifier: MIT
#include "scene/session/session_state.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/file/json/change_json.h"
#include "scene/file/scene_file.h"
#include "scene/session/building.h"
#include "scene/session/catalog_edit.h"
#include "scene/session/kept_forms.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::size_t timed_steps = 120;
}  // namespace

Document new_document(const std::string& title) {
    Document document;
    document.title = title;
    Entity floor;
    floor.index = document.next_index++;
    floor.name = "Floor";
    floor.category = "floor";
    floor.geometry = physics::ShapeDefinition{physics::BoxShape{{15, 0.25, 15}}};
    floor.pose.position = {0, -0.25, 0};
    floor.attributes["kind"] = to_value(attributes::PhysicalKind::static_body);
    floor.color = {0.5, 0.5, 0.48};
    floor.locked = true;
    document.entities.push_back(std::move(floor));
    document.camera = {Vec3{4, 3, 6}, Vec3{0, 0.5, 0}};
    return document;
}

SessionState::SessionState(catalog::Catalog* used_catalog, SessionOptions used_options)
    : catalog(used_catalog), options(std::move(used_options)), definitions(used_catalog, forms) {
    past.take = Take(options.take_bytes);
}

// Simulation
// -----------------------------------------------------------------------------------------------------------

Result<void> SessionState::rebuild_simulation() {
    Result<std::unique_ptr<Simulation>> made = Simulation::create(document, catalog, forms, MissingModels::wait);
    if (!made.ok()) return made.error();
    simulation = std::move(made).value();
    simulation_is_pristine = true;
    past.clear();
    hands.clear();
    impacts = {};
    step_times.clear();
    told_limits = 0;
    told_problems.clear();
    return {};
}

void SessionState::set_play_state(PlayState state) {
    if (state == play_state) return;
    if (play_state == PlayState::playing && !past.shown) past.take.add_now(*simulation);
    play_state = state;
    step_times.clear();
    tell(simulation_event());
    tell_take();
}

void SessionState::step() {
    if (past.shown) {
        // At its end the take goes over into the simulation.
        if (const double time = shown_time() + document.settings.time_step; time < past.take.end())
            show(past.take.at(time));
        else
            look_now();
        return;
    }
    hands.before_step(*simulation);
    simulation_is_pristine = false;
    simulation->step();
    step_times.push_back(std::chrono::steady_clock::now());
    if (step_times.size() > timed_steps) step_times.pop_front();
    record_step();
    tell_step();
    tell_strikes();
    tell_impacts();
    if (simulation->pause_requested()) set_play_state(PlayState::paused);
}

// Edits
// ----------------------------------------------------------------------------------------------------------------

// Applies an entity's change, already in the document, to the simulation.
Result<void> SessionState::sync_entity(const EntityChange& change) {
    if (!change.before) return simulation->add(*document.find(change.after->index));
    const EntityIndex index = change.before->index;
    // An action may have removed it.
    const bool is_waiting = simulation->is_waiting(index);
    if (!is_waiting && !simulation->contains(index)) return {};
    if (!change.after) return simulation->remove(index);
    const Entity& entity = *document.find(index);
    if (is_waiting || play_state == PlayState::stopped) return simulation->update(entity, false);

    // In a run the entity keeps its present state, except for the fields of this change.
    if (Result<void> updated = simulation->update(entity, true); !updated.ok()) return updated;
    if (change.before->pose != change.after->pose)
        if (Result<void> moved = simulation->set_pose(index, entity.pose); !moved.ok()) return moved;
    if (change.before->linear_velocity != change.after->linear_velocity ||
        change.before->angular_velocity != change.after->angular_velocity)
        return simulation->set_velocity(index, entity.linear_velocity, entity.angular_velocity);
    return {};
}

Result<void> SessionState::sync_heading(const HeadingChange& change) {
    return simulation->set_settings(change.after->settings);
}

Result<void> SessionState::sync(const Change& change) {
    simulation_is_pristine = false;
    if (const auto* entity = std::get_if<EntityChange>(&change)) return sync_entity(*entity);
    if (const auto* heading = std::get_if<HeadingChange>(&change)) return sync_heading(*heading);
    if (std::holds_alternative<ActionChange>(change)) {
        simulation->set_actions(document.actions);
        return {};
    }
    if (const auto* joint = std::get_if<JointChange>(&change)) {
        if (joint->before && simulation->contains_joint(joint->before->index))
            if (Result<void> removed = simulation->remove_joint(joint->before->index); !removed.ok()) return removed;
        if (!joint->after) return {};
        Result<void> added = simulation->add_joint(*joint->after);
        if (!added.ok() && joint->before) (void)simulation->add_joint(*joint->before).ok();
        return added;
    }

    // A thing that is moved by hand is at rest at its new pose.
    const auto& pose = std::get<PoseChange>(change);
    if (simulation->is_waiting(pose.index)) return simulation->update(*document.find(pose.index), false);
    if (!simulation->contains(pose.index)) return {};
    if (Result<void> moved = simulation->set_pose(pose.index, pose.after); !moved.ok()) return moved;
    if (play_state == PlayState::stopped) return {};
    return simulation->set_velocity(pose.index, {}, {});
}

void SessionState::put_in_document(const std::vector<Change>& changes) {
    apply_changes(document, changes);
    lookup.apply(changes);
}

// Removes entities that go in a row from the simulation together; returns their number.
std::size_t SessionState::sync_removals(std::span<const Change> changes) {
    std::vector<EntityIndex> gone;
    for (const Change& change : changes) {
        const auto* entity = std::get_if<EntityChange>(&change);
        if (!entity || entity->after) break;
        gone.push_back(entity->before->index);
    }
    if (gone.empty()) return 0;
    simulation_is_pristine = false;
    simulation->remove_all(gone);
    return gone.size();
}

// Applies all changes or none.
Result<void> SessionState::run_changes(const std::vector<Change>& changes) {
    look_now();
    put_in_document(changes);
    // Kept forms fill the space that others leave free: all change together.
    if (play_state == PlayState::stopped && change_kept_forms(changes)) return rebuild_or_revert(changes);
    std::size_t synced = 0;
    Result<void> done;
    try {
        while (done.ok() && synced < changes.size()) {
            const std::size_t gone = sync_removals(std::span(changes).subspan(synced));
            if (gone == 0) done = sync(changes[synced]);
            if (done.ok()) synced += std::max<std::size_t>(gone, 1);
        }
    } catch (...) {
        put_in_document(reversed(changes));
        throw;
    }
    if (done.ok()) return done;
    put_in_document(reversed(changes));
    // The change that failed has changed nothing in the simulation.
    while (synced-- > 0) (void)sync(reversed(changes[synced])).ok();
    if (play_state == PlayState::stopped) (void)rebuild_simulation().ok();
    return done;
}

Result<void> SessionState::rebuild_or_revert(const std::vector<Change>& changes) {
    Result<void> made = rebuild_simulation();
    if (!made.ok()) {
        put_in_document(reversed(changes));
        return made;
    }
    events.all_poses = true;
    return made;
}

// Undo and redo lead to a document that existed before; no state of a run may prevent it.
Result<void> SessionState::force_changes(const std::vector<Change>& changes) {
    Result<void> done = run_changes(changes);
    if (done.ok() || play_state == PlayState::stopped) return done;
    put_in_document(changes);
    if (Result<void> made = rebuild_or_revert(changes); !made.ok()) return made;
    tell_message("warning", "The running simulation could not follow and was reset: " + done.error().message());
    set_play_state(PlayState::stopped);
    return {};
}

Edit SessionState::start_edit(std::string label) {
    Edit edit;
    edit.person = person();
    edit.label = std::move(label);
    edit.next_before = edit.next_after = document.next_index;
    return edit;
}

void SessionState::record(Edit edit) {
    document.next_index = edit.next_after;
    history.add(std::move(edit));
}

Result<void> SessionState::commit(Edit edit) {
    if (edit.changes.empty()) return {};
    for (const Change& change : edit.changes)
        if (Result<void> allowed = check_lock(change); !allowed.ok()) return allowed;
    complete_building(*this, edit);
    const std::vector<std::string> as_modelled = drop_unfit_forms(*this, edit);
    if (Result<void> done = run_changes(edit.changes); !done.ok()) return done;
    json told = told_changes(edit.changes);
    record(std::move(edit));
    keep_and_tell(std::move(told));
    for (const std::string& text : as_modelled) tell_message("info", text);
    return {};
}

Result<std::vector<Change>> SessionState::step_changes(const Edit& edit, std::vector<Change> recorded) {
    // Title and camera change with a save, too, which is no step: the heading is always taken as it is now.
    const bool has_heading = std::any_of(recorded.begin(), recorded.end(), [](const Change& change) {
        return std::holds_alternative<HeadingChange>(change);
    });
    if (has_heading || history.is_followed(edit)) {
        Rebased now = rebased(recorded, document, lookup);
        if (now.conflict) return refusal_of_step(edit, *now.conflict);
        recorded = std::move(now.changes);
    }
    // A thing that goes is as the step left it, locked or not; what moves or changes may have been locked since.
    for (const Change& change : recorded) {
        const auto* entity = std::get_if<EntityChange>(&change);
        if (entity && !entity->after) continue;
        if (Result<void> allowed = check_lock(change); !allowed.ok()) return allowed.error();
    }
    return recorded;
}

Error SessionState::refusal_of_step(const Edit& edit, const Conflict& conflict) const {
    const ChangedThing thing = conflict.thing;
    const Edit* other = history.last_of_others(edit.person, thing);
    const std::string what = thing.kind == ChangedThing::Kind::entity   ? called({thing.number})
                             : thing.kind == ChangedThing::Kind::joint  ? "joint " + std::to_string(thing.number)
                             : thing.kind == ChangedThing::Kind::action ? "action " + std::to_string(thing.number)
                                                                        : "the scene";
    return {edit.label, what + ": " + conflict.why + (other ? " by " + people.person_called(other->person) : ""),
            "change it by hand, or have the later change undone first; the next undo takes back the step before"};
}

Result<std::string> SessionState::undo() {
    const Edit* edit = history.undoable(person());
    if (!edit) return std::string();
    if (edit->catalog) return undo_on_catalog(*this);
    Result<std::vector<Change>> changes = step_changes(*edit, reversed(edit->changes));
    if (!changes.ok()) {
        history.set_aside(edit->person);
        tell_histories();
        return changes.error();
    }
    if (Result<void> done = force_changes(changes.value()); !done.ok()) return done.error();
    std::string label = edit->label;
    // While somebody else is here, an index that was used is not used again: redo needs it.
    if (document.next_index == edit->next_after && people.others(client).empty())
        document.next_index = edit->next_before;
    history.move_back(edit->person, reversed(changes.value()));
    keep_and_tell(told_changes(changes.value()));
    return label;
}

Result<std::string> SessionState::redo() {
    const Edit* edit = history.redoable(person());
    if (!edit) return std::string();
    if (edit->catalog) return redo_on_catalog(*this);
    Result<std::vector<Change>> changes = step_changes(*edit, edit->changes);
    if (!changes.ok()) return changes.error();
    if (Result<void> done = force_changes(changes.value()); !done.ok()) return done.error();
    std::string label = edit->label;
    document.next_index = std::max(document.next_index, edit->next_after);
    json told = told_changes(changes.value());
    history.move_forward(edit->person, std::move(changes).value());
    keep_and_tell(std::move(told));
    return label;
}

Result<void> SessionState::open(Document opened, std::string opened_name, bool is_unsaved) {
    Result<std::unique_ptr<Simulation>> made = Simulation::create(opened, catalog, forms, MissingModels::wait);
    if (!made.ok()) return made.error();
    // Where the old document was saved its journal has gone already; else it becomes a recovery.
    journal.reset();
    std::swap(document, opened);
    lookup.assign(document);
    name = std::move(opened_name);
    history.clear();
    if (is_unsaved) history.mark_unsaved();
    simulation = std::move(made).value();
    simulation_is_pristine = true;
    past.clear();
    hands.clear();
    impacts = {};
    told_limits = 0;
    told_problems.clear();
    told_notes.clear();
    play_state = PlayState::stopped;
    step_times.clear();
    const json changes = json::array({{{"op", "reset"}, {"scene", document_to_json(document)}}});
    if (is_unsaved) keep(changes);
    tell_document(changes);
    people.forget_presences();
    told_waiting.clear();
    tell_waiting_models();
    tell(simulation_event());
    tell_take();
    events.all_poses = true;
    return {};
}

// Journal
// --------------------------------------------------------------------------------------------------------------

std::filesystem::path SessionState::journal_folder() const {
    return options.saved_scenes.empty() ? std::filesystem::path() : options.saved_scenes / "autosave";
}

json SessionState::told_changes(const std::vector<Change>& changes) const {
    json told = json::array();
    for (const Change& change : changes) told.push_back(change_to_json(change, document));
    return told;
}

void SessionState::keep_and_tell(json changes) {
    keep(changes);
    tell_document(std::move(changes));
}

void SessionState::keep(const json& changes) {
    if (journal_folder().empty()) return;
    // Undo led back to what is on disk.
    if (history.is_saved()) return mark_saved();
    // The edit is done already: whatever fails here is told, and the next edit tries to write all.
    Result<void> kept;
    try {
        kept = add_to_journal(changes);
    } catch (const std::exception& thrown) {
        kept = Error{journal_folder().string(), thrown.what()};
    }
    if (!kept.ok() && !is_unkept) tell_message("error", "Edits are not kept on disk: " + kept.error().message());
    is_unkept = !kept.ok();
}

Result<void> SessionState::add_to_journal(const json& changes) {
    if (journal) return journal->add(changes, document);
    Result<std::unique_ptr<Journal>> begun = Journal::begin(journal_folder(), name, document);
    if (!begun.ok()) return begun.error();
    journal = std::move(begun).value();
    return {};
}

void SessionState::mark_saved() {
    history.mark_saved();
    if (journal) journal->remove();
    journal.reset();
}

// Names
// ----------------------------------------------------------------------------------------------------------------

Result<void> SessionState::check_unlocked(EntityIndex index) const {
    const Entity* entity = document.find(index);
    if (!entity || !entity->locked) return {};
    return Error{"entity " + std::to_string(index), called({index}) + " is locked", "unlock it first"};
}

Result<void> SessionState::check_lock(const Change& change) const {
    if (const auto* pose = std::get_if<PoseChange>(&change)) return check_unlocked(pose->index);
    const auto* entity = std::get_if<EntityChange>(&change);
    if (!entity || !entity->before) return {};
    const bool is_same_shape =
        entity->same_geometry || (entity->after && are_same_wall(entity->before->geometry, entity->after->geometry));
    const bool stays = entity->after && is_same_shape && entity->before->pose == entity->after->pose &&
                       entity->before->scale == entity->after->scale &&
                       entity->before->enabled == entity->after->enabled;
    return stays ? Result<void>{} : check_unlocked(entity->before->index);
}

Result<const Entity*> SessionState::entity(EntityIndex index, const std::string& where) const {
    if (const Entity* found = document.find(index)) return found;
    return Error{where, "there is no entity " + std::to_string(index) + " in the scene"};
}

std::string SessionState::called(const std::vector<EntityIndex>& indices) const {
    if (indices.size() != 1) return std::to_string(indices.size()) + " entities";
    const Entity* entity = document.find(indices.front());
    if (!entity || entity->name.empty()) return "entity " + std::to_string(indices.front());
    return entity->name;
}

}  // namespace embody::scene
