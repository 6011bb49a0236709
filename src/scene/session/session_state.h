// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/document/document_index.h"
#include "scene/document/history.h"
#include "scene/document/rebase.h"
#include "scene/embody/entity_definitions.h"
#include "scene/session/hands.h"
#include "scene/session/impacts.h"
#include "scene/session/journal.h"
#include "scene/session/opening.h"
#include "scene/session/past.h"
#include "scene/session/people.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

enum class PlayState : std::uint8_t { stopped, playing, paused };

/// State of a session that its commands work on: the document with its history, its simulation, and events that clients
/// have not got yet.
struct SessionState {
    SessionState(catalog::Catalog* catalog, SessionOptions options);

    catalog::Catalog* catalog = nullptr;
    SessionOptions options;
    std::shared_ptr<FormCache> forms = std::make_shared<FormCache>();  ///< of all simulations of this session
    EntityDefinitions definitions;

    Document document;
    DocumentIndex lookup;  ///< of the document
    std::string name;      ///< of the file; empty: not saved yet
    std::uint64_t revision = 0;
    History history;
    std::unique_ptr<Journal> journal;  ///< of the unsaved edits; null where there are none
    bool is_unkept = false;            ///< the last edits could not be written to the journal

    /// Never null: while stopped it holds the document's poses, for picking and placing.
    std::unique_ptr<Simulation> simulation;
    bool simulation_is_pristine = true;  ///< made in one go from the present document
    PlayState play_state = PlayState::stopped;
    Hands hands;
    std::set<ClientId> impact_listeners;  ///< clients that want to know what strikes what
    Past past;
    StrongestImpacts impacts;  ///< that they were not told yet
    Pace impact_pace{20};
    std::deque<std::chrono::steady_clock::time_point> step_times;  ///< of the last steps
    std::uint32_t told_limits = 0;                                 ///< of this run
    std::set<std::string> told_problems;
    std::set<std::string> told_notes;       ///< of this document
    std::vector<EntityIndex> told_waiting;  ///< entities that wait for their models, as clients know

    Events events;

    ClientId client = 0;  ///< whose command is being executed
    People people;
    std::optional<Question> question;  ///< what members are being asked
    std::uint64_t last_question = 0;

    /// Applies the edit to document and simulation and tells clients. On failure nothing has changed.
    Result<void> commit(Edit edit);
    /// Adds an edit that was done to the history.
    void record(Edit edit);
    /// The person whose command is being executed.
    [[nodiscard]] PersonId person() { return people.client(client).person; }
    /// The label of the person's edit that was undone or redone; empty: there was none.
    Result<std::string> undo();
    Result<std::string> redo();
    /// An edit with the document's present next_index in it.
    [[nodiscard]] Edit start_edit(std::string label);

    /// The document as it is now is on disk.
    void mark_saved();
    /// The folder of journals; empty where no scenes are saved.
    [[nodiscard]] std::filesystem::path journal_folder() const;

    /// Opens another document, without history. On failure the old one stays. Unsaved work of the old one stays in its
    /// journal, as a recovery.
    Result<void> open(Document opened, std::string opened_name, bool is_unsaved = false);
    /// A new simulation of the document.
    Result<void> rebuild_simulation();
    void set_play_state(PlayState state);
    /// A step of the simulation, or of the take while a moment of it is shown.
    void step();

    // The take, and moments of it (session_time.cpp)
    // -------------------------------------------------------------------

    /// Time (s) and step of what is shown: now, or a moment of the take.
    [[nodiscard]] double shown_time() const;
    [[nodiscard]] std::uint64_t shown_step() const;
    /// Entities that are shown, ascending.
    [[nodiscard]] std::vector<EntityIndex> shown_entities() const;
    /// Whether the document has the entity, or an action spawned it in this run.
    [[nodiscard]] bool is_known(EntityIndex index) const;
    /// Shows everybody the take at this time, s, paused; at its end and later: what is now.
    Result<void> look_at(double time);
    /// Shows what is now.
    void look_now();
    /// Goes on from the moment that is shown; tells what could not be restored.
    Result<std::vector<std::string>> branch();
    /// Where the take begins, for a run that starts.
    void begin_take() { past.take.add_now(*simulation); }
    [[nodiscard]] nlohmann::json take_json() const;
    void tell_take();
    /// What the client holds and touches is left alone, and it is told of no impacts any more.
    void forget_hands(ClientId who);

    void tell(nlohmann::json message);
    void tell_to(ClientId recipient, nlohmann::json message);  ///< tells one client only
    void tell_message(const char* level, std::string text);
    void tell_spawned(const Entity& entity);
    void tell_document(nlohmann::json changes);
    /// Tells each client that has said hello what its person can undo and redo now, where that has changed.
    void tell_histories();
    /// Which entities wait for their models, where that has changed.
    void tell_waiting();
    /// Puts what waited for models that are there now into the simulation; returns whether there was any.
    bool follow_arrivals();
    [[nodiscard]] nlohmann::json simulation_json() const;
    [[nodiscard]] nlohmann::json simulation_event() const;

    /// An error that names the entity where it is locked.
    Result<void> check_unlocked(EntityIndex index) const;
    /// The document's entity, or an error that names the field.
    Result<const Entity*> entity(EntityIndex index, const std::string& where) const;
    /// The entity's name for a label, or "3 entities".
    [[nodiscard]] std::string called(const std::vector<EntityIndex>& indices) const;

private:
    /// An error where the change moves, scales, reshapes, disables or removes something that is locked.
    Result<void> check_lock(const Change& change) const;
    Result<void> sync(const Change& change);
    std::size_t sync_removals(std::span<const Change> changes);
    Result<void> sync_entity(const EntityChange& change);
    Result<void> sync_heading(const HeadingChange& change);
    void put_in_document(const std::vector<Change>& changes);
    Result<void> run_changes(const std::vector<Change>& changes);
    /// A new simulation of a document that has the changes; where there can be none the document gets them back.
    Result<void> rebuild_or_revert(const std::vector<Change>& changes);
    Result<void> force_changes(const std::vector<Change>& changes);
    /// What a step of undo or redo changes in the document as it is.
    Result<std::vector<Change>> step_changes(const Edit& edit, std::vector<Change> recorded);
    [[nodiscard]] Error refusal_of_step(const Edit& edit, const Conflict& conflict) const;
    /// Changes that the document has in it, for clients and the journal.
    [[nodiscard]] nlohmann::json told_changes(const std::vector<Change>& changes) const;
    void keep_and_tell(nlohmann::json changes);
    /// Appends an edit to the journal.
    void keep(const nlohmann::json& changes);
    Result<void> add_to_journal(const nlohmann::json& changes);
    void show(std::optional<Moment> moment);
    void record_step();
    void tell_step();
    void tell_strikes();
    void tell_impacts();
    void tell_notes();
    void tell_waiting_models();
};

/// The document that scene.new makes: a floor to put things on.
Document new_document(const std::string& title);

}  // namespace embody::scene
