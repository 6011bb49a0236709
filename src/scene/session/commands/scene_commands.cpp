// SPDX-License-Identifier: MIT
#include <filesystem>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "foundation/version.h"
#include "scene/document/document_field.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/json/text.h"
#include "scene/file/scene_file.h"
#include "scene/session/commands/commands.h"
#include "scene/session/scene_folders.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr int frame_version = 2;

// Everything that a client needs to draw the scene and to follow it.
Result<json> hello(SessionState& state, const json& params) {
    if (!params.is_null() && !(params.is_object() && params.empty())) return Error{"params", "hello takes none"};
    const auto label = [](const Edit* edit) { return edit ? json(edit->label) : json(nullptr); };

    // Entities in the world but not in the document, and the reverse.
    json spawned = json::array(), despawned = json::array();
    for (const EntityIndex index : state.simulation->entities())
        if (!state.document.find(index)) spawned.push_back(entity_to_json(*state.simulation->definition(index)));
    for (const Entity& entity : state.document.entities)
        if (!state.simulation->contains(entity.index)) despawned.push_back(entity.index);
    return json{{"version", version_text},
                {"scene", document_to_json(state.document)},
                {"revision", state.revision},
                {"simulation", state.simulation_json()},
                {"frame_version", frame_version},
                {"undo", label(state.history.undoable())},
                {"redo", label(state.history.redoable())},
                {"unsaved", !state.history.is_saved()},
                {"name", state.name},
                {"client", state.client},
                {"spawned", std::move(spawned)},
                {"despawned", std::move(despawned)}};
}

Result<json> make_new(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string title = "Untitled";
    reader.text("name", title);
    if (!reader.finish()) return *error;
    return done(state.open(new_document(title), ""));
}

// A refusal of physics names the field in `place`, such as a file; empty where there is none.
Result<json> open_document(SessionState& state, Document document, const std::string& name, const std::string& place) {
    if (Result<void> opened = state.open(std::move(document), name); !opened.ok())
        return in_place(place, opened.error());
    return json::object();
}

Result<json> load(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name, text, file_name = "text";
    const bool by_name = reader.text("name", name);
    const json* scene = reader.take("scene");
    const bool by_text = reader.text("text", text);
    reader.text("file", file_name);
    if (!reader.finish()) return *error;
    if (int{by_name} + int{scene != nullptr} + int{by_text} != 1)
        return Error{"name", "say either a name, the scene itself, or the text of its file"};

    // The document is in no file: its fields are fields of this command.
    if (scene) {
        Result<Document> document = document_from_json(*scene);
        if (document.ok()) return open_document(state, std::move(document).value(), "", "");
        Error refused = document.error();
        refused.where = "scene" + (refused.where.empty() ? "" : "." + refused.where);
        return refused;
    }
    if (by_text) {
        const Result<json> read = parse_json(text, file_name);
        if (!read.ok()) return read.error();
        Result<Document> document = document_from_json(read.value());
        if (!document.ok()) return in_place(file_name, document.error());
        return open_document(state, std::move(document).value(), "", file_name);
    }
    const Result<std::filesystem::path> file = find_scene(state.options, name);
    if (!file.ok()) return file.error();
    Result<Document> document = load_document(file.value());
    if (!document.ok()) return document.error();
    const bool is_recovered = name.starts_with("autosave/");
    const std::string plain = name_of_scene(file.value());
    Result<json> opened = open_document(state, std::move(document).value(), plain, file.value().string());
    if (opened.ok() && is_recovered) {
        const std::lock_guard lock(state.rescue_mutex);
        state.history.mark_unsaved();
    }
    return opened;
}

Result<json> save(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name = state.name.empty() ? state.document.title : state.name;
    reader.text("name", name);
    if (!reader.finish()) return *error;
    name = trimmed_name(name);
    const Result<std::filesystem::path> file = saved_file(state.options, name);
    if (!file.ok()) return file.error();
    if (Result<void> written = save_document(state.document, *file); !written.ok()) return written.error();

    // The content of the autosave is saved now.
    std::error_code ignored;
    std::filesystem::remove(autosave_file(state.options, state.name.empty() ? state.document.title : state.name),
                            ignored);
    std::filesystem::remove(autosave_file(state.options, name), ignored);
    {
        const std::lock_guard lock(state.rescue_mutex);
        state.name = name;
        state.history.mark_saved();
    }
    state.tell_document(json::array());
    state.mark_autosaved();
    return json{{"name", name}, {"path", file->string()}};
}

Result<json> list(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    json scenes = json::array();
    for (const ListedScene& scene : list_scenes(state.options))
        scenes.push_back(
            {{"name", scene.name}, {"title", scene.title}, {"kind", scene.kind}, {"modified", scene.modified}});
    return json{{"scenes", std::move(scenes)}};
}

// The fields of the document's heading, with those of its settings beside them.
Result<json> settings(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Edit edit = state.start_edit("Change settings");
    HeadingChange change{state.document, state.document};
    for_each_field<Heading>([&](const auto& field) {
        if constexpr (!std::is_same_v<typename std::remove_cvref_t<decltype(field)>::Member, physics::WorldSettings>)
            read_field(reader, field, change.after);
    });
    read_fields(reader, change.after.settings);
    reader.text("merge", edit.merge);
    if (reader.finish()) check_value(reader, change.after.settings);
    if (error) return *error;
    edit.changes.emplace_back(std::move(change));
    return done(state.commit(std::move(edit)));
}

Result<json> undo(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    const Result<std::string> label = state.undo();
    if (!label.ok()) return label.error();
    return json{{"undone", label.value().empty() ? json(nullptr) : json(label.value())}};
}

Result<json> redo(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    const Result<std::string> label = state.redo();
    if (!label.ok()) return label.error();
    return json{{"redone", label.value().empty() ? json(nullptr) : json(label.value())}};
}

}  // namespace

std::span<const Command> scene_commands() {
    static constexpr Command commands[] = {{"hello", hello},     {"scene.new", make_new}, {"scene.load", load},
                                           {"scene.save", save}, {"scene.list", list},    {"scene.settings", settings},
                                           {"edit.undo", undo},  {"edit.redo", redo}};
    return commands;
}

}  // namespace embody::scene
