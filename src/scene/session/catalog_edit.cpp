// SPDX-License-Identifier: MIT
#include "scene/session/catalog_edit.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "attributes/registry.h"

namespace embody::scene {

using catalog::ChangeReport;
using nlohmann::json;

namespace {

/// An event names at most this many models; if more changed, it names none.
constexpr std::size_t max_told_models = 1000;

std::string attribute_text(const std::vector<std::string>& names) {
    if (names.size() != 1) return std::to_string(names.size()) + " attributes";
    const attributes::AttributeDescription* description = attributes::describe(names.front());
    return description && !description->label.empty() ? description->label : names.front();
}

std::string called(const catalog::ChangeRecord& change) {
    return change.model_name.empty() ? change.model_key : change.model_name;
}

std::string label_text(const std::string& command, const std::vector<std::string>& names,
                       const std::string& first_model, std::size_t models) {
    const char* act = command.starts_with("reset") ? "Reset " : command == "undo" ? "Take back " : "Set ";
    const std::string of = models == 1 ? first_model : std::to_string(models) + " models";
    return act + attribute_text(names) + " of " + of;
}

// Makes everything that the open scene has of these models again; in a run it goes on from its present state.
void take_up(SessionState& state, const std::set<std::string>& keys) {
    for (const std::string& key : keys) state.definitions.forget(key);
    state.simulation_is_pristine = false;
    const Result<void> renewed = state.simulation->renew_models(keys, state.play_state != PlayState::stopped);
    if (!renewed.ok())
        state.tell_message("warning", "The scene could not follow the changed models: " + renewed.error().message());
}

void tell_models(SessionState& state, json event, const std::set<std::string>& keys, std::size_t models) {
    event["event"] = "catalog";
    event["models"] = models;
    event["keys"] = keys.size() == models && models <= max_told_models ? json(keys) : json(nullptr);
    state.tell(std::move(event));
}

// Updates the scene and tells all clients after an act of the client whose command is being executed.
void follow(SessionState& state, const ChangeReport& report) {
    std::set<std::string> keys;
    for (const catalog::ChangedModel& model : report.models) keys.insert(model.key);
    take_up(state, keys);
    tell_models(state,
                {{"batch", report.batch},
                 {"command", report.command},
                 {"label", label_of(report)},
                 {"attributes", report.attributes},
                 {"session", acting_session(state)},
                 {"client", state.client}},
                keys, keys.size());
}

catalog::ChangeOptions watched(const SessionState& state, catalog::ChangeOptions options) {
    if (!options.dry_run) options.progress = state.options.progress;
    return options;
}

// Reverts a batch and tells all clients; if some values are refused, that is an error, as undo is all or nothing.
Result<ChangeReport> take_back(SessionState& state, std::int64_t batch) {
    if (!state.catalog) return Error{"catalog", "no model database is open", "start with --database FILE"};
    state.catalog->set_session(acting_session(state));
    Result<ChangeReport> report = state.catalog->undo_changes(batch, watched(state, {}));
    if (!report.ok()) return report;
    if (!report.value().refused.empty()) {
        const catalog::RefusedChange& first = report.value().refused.front();
        const std::size_t more = report.value().refused.size() - 1;
        return Error{"batch " + std::to_string(batch),
                     "nothing was undone: the " + attribute_text({first.attribute}) + " of " + first.name + " " +
                         first.why + (more > 0 ? ", and so were " + std::to_string(more) + " more values" : ""),
                     "undo the later change first, or set the values anew"};
    }
    if (report.value().batch != 0) follow(state, report.value());
    return report;
}

// Whether the refusal is permanent, because of later changes to the batch; a busy database or a stop is not.
bool is_for_ever(const Error& error) { return error.where.starts_with("batch "); }

}  // namespace

std::string acting_session(const SessionState& state) {
    const auto client = state.people.clients().find(state.client);
    if (client != state.people.clients().end() && !client->second.name.empty()) return "studio: " + client->second.name;
    return "studio " + std::to_string(state.client);
}

std::string label_of(const ChangeReport& report) {
    return label_text(report.command, report.attributes, report.models.empty() ? "" : report.models.front().name,
                      report.models.size());
}

Result<ChangeReport> change_models(SessionState& state, const catalog::Catalog::ModelChoice& models,
                                   const std::vector<catalog::AttributeChange>& changes,
                                   catalog::ChangeOptions options) {
    if (!state.catalog) return Error{"catalog", "no model database is open", "start with --database FILE"};
    state.catalog->set_session(acting_session(state));
    Result<ChangeReport> report = state.catalog->change_attributes(models, changes, watched(state, options));
    if (!report.ok() || report.value().batch == 0) return report;
    follow(state, report.value());
    Edit edit = state.start_edit(label_of(report.value()));
    edit.catalog = CatalogStep{report.value().batch, 0};
    state.record(std::move(edit));
    state.tell_document(json::array());
    return report;
}

Result<ChangeReport> undo_models(SessionState& state, std::int64_t batch) {
    // The batch of the next undo or redo is reverted as that undo or redo. Another batch is reverted by a new edit:
    // edits before it keep their order, and undo reaches them after the new edit itself was undone.
    const Edit* last = state.history.undoable(state.person());
    const Edit* next = state.history.redoable(state.person());
    const bool is_last = last && last->catalog && last->catalog->back == batch;
    const bool is_next = next && next->catalog && next->catalog->again == batch;
    Result<ChangeReport> report = take_back(state, batch);
    if (!report.ok() || report.value().batch == 0) return report;
    if (is_last) {
        state.history.move_back(state.person(), report.value().batch);
    } else if (is_next) {
        state.history.move_forward(state.person(), {});
    } else {
        Edit edit = state.start_edit(label_of(report.value()));
        edit.catalog = CatalogStep{report.value().batch, 0};
        state.record(std::move(edit));
    }
    state.tell_document(json::array());
    return report;
}

Result<std::string> undo_on_catalog(SessionState& state) {
    const Edit edit = *state.history.undoable(state.person());
    const Result<ChangeReport> report = take_back(state, edit.catalog->back);
    if (report.ok())
        state.history.move_back(state.person(), report.value().batch);
    else if (is_for_ever(report.error()))
        state.history.drop_undoable(state.person());
    state.tell_document(json::array());
    if (!report.ok()) return report.error();
    return edit.label;
}

Result<std::string> redo_on_catalog(SessionState& state) {
    const Edit edit = *state.history.redoable(state.person());
    const Result<ChangeReport> report = take_back(state, edit.catalog->again);
    if (report.ok())
        state.history.move_forward(state.person(), {});
    else if (is_for_ever(report.error()))
        state.history.drop_redoable(state.person());
    state.tell_document(json::array());
    if (!report.ok()) return report.error();
    return edit.label;
}

bool follow_changes_of_others(SessionState& state) {
    if (!state.catalog) return false;
    const auto batches = state.catalog->changes_of_others();
    if (!batches.ok()) return false;
    for (const catalog::ChangeBatchRecord& batch : batches.value()) {
        const catalog::ChangeRecord& first = batch.changes.front();
        std::set<std::string> keys;
        std::vector<std::string> names;
        for (const catalog::ChangeRecord& change : batch.changes) {
            keys.insert(change.model_key);
            if (std::find(names.begin(), names.end(), change.attribute) == names.end())
                names.push_back(change.attribute);
        }
        // Only the first models of very many are named: then all models of the scene are checked.
        std::set<std::string> meant = keys;
        if (keys.size() < batch.models) {
            for (const EntityIndex index : state.simulation->entities()) {
                const Entity* entity = state.simulation->definition(index);
                if (const auto* model = std::get_if<ModelReference>(&entity->geometry)) meant.insert(model->key);
            }
        }
        take_up(state, meant);
        tell_models(state,
                    {{"batch", first.batch},
                     {"command", first.command},
                     {"label", label_text(first.command, names, called(first), batch.models)},
                     {"attributes", names},
                     {"session", first.author.session},
                     {"client", nullptr}},
                    keys, batch.models);
    }
    return !batches.value().empty();
}

}  // namespace embody::scene
