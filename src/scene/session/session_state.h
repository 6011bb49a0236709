// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/document/document_index.h"
#include "scene/document/history.h"
#include "scene/embody/entity_definitions.h"
#include "scene/session/session.h"
#include "scene/simulation/grab.h"
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

    /// Locked while the document, its name, revisions and history change: another thread may read them to save unsaved
    /// work. Never locked for long.
    std::mutex rescue_mutex;
    const std::vector<Change>* changes_in_hand = nullptr;  ///< in the document but not in the simulation yet

    Document document;
    DocumentIndex lookup;  ///< of the document
    std::string name;      ///< of the file; empty: not saved yet
    std::uint64_t revision = 0;
    std::uint64_t autosaved_revision = 0;
    History history;

    /// Never null: while stopped it holds the document's poses, for picking and placing.
    std::unique_ptr<Simulation> simulation;
    bool simulation_is_pristine = true;  ///< made in one go from the present document
    PlayState play_state = PlayState::stopped;
    std::optional<Grab> grab;
    std::deque<std::chrono::steady_clock::time_point> step_times;  ///< of the last steps
    std::uint32_t told_limits = 0;                                 ///< of this run
    std::set<std::string> told_problems;
    std::set<std::string> told_notes;  ///< of this document

    Events events;

    ClientId client = 0;                           ///< whose command is being executed
    std::map<ClientId, std::string> client_names;  ///< of clients that sent their name

    /// Applies the edit to document and simulation and tells clients. On failure nothing has changed.
    Result<void> commit(Edit edit);
    /// Adds an edit that was done to the history.
    void record(Edit edit);
    /// The label of the edit that was undone or redone; empty: there was none.
    Result<std::string> undo();
    Result<std::string> redo();
    /// An edit with the document's present next_index in it.
    [[nodiscard]] Edit start_edit(std::string label) const;

    /// The document as it is now is on disk.
    void mark_autosaved();

    /// Opens another document, without history. On failure the old one stays.
    Result<void> open(Document opened, std::string opened_name);
    /// A new simulation of the document.
    Result<void> rebuild_simulation();
    void set_play_state(PlayState state);
    void step();

    void tell(nlohmann::json message);
    void tell_message(const char* level, std::string text);
    void tell_document(nlohmann::json changes);
    [[nodiscard]] nlohmann::json simulation_json() const;
    [[nodiscard]] nlohmann::json simulation_event() const;

    /// The document's entity, or an error that names the field.
    Result<const Entity*> entity(EntityIndex index, const std::string& where) const;
    /// The entity's name for a label, or "3 entities".
    [[nodiscard]] std::string called(const std::vector<EntityIndex>& indices) const;

private:
    Result<void> sync(const Change& change);
    std::size_t sync_removals(std::span<const Change> changes);
    Result<void> sync_entity(const EntityChange& change);
    Result<void> sync_heading(const HeadingChange& change);
    void put_in_document(const std::vector<Change>& changes, bool is_in_hand);
    Result<void> run_changes(const std::vector<Change>& changes);
    Result<void> force_changes(const std::vector<Change>& changes);
    void tell_step();
    void tell_notes();
    [[nodiscard]] nlohmann::json change_json(const Change& change) const;
};

/// The document that scene.new makes: a floor to put things on.
Document new_document(const std::string& title);

}  // namespace embody::scene
