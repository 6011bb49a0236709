// SPDX-License-Identifier: MIT
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <utility>

#include "scene/document/document_field.h"
#include "scene/file/json/change_json.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/json/text.h"
#include "scene/file/scene_file.h"
#include "scene/session/commands/commands.h"
#include "scene/session/scene_folders.h"

namespace embody::scene {

using nlohmann::json;

namespace {

Result<json> make_new(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string title = "Untitled";
    bool ask = true;
    reader.text("name", title);
    reader.truth("ask", ask);
    if (!reader.finish()) return *error;
    return open_or_ask(state, {.document = new_document(title)}, ask);
}

// A scene file of one of the folders, a version of one, or a journal.
Result<Opening> read_named(const SessionState& state, const std::string& name, const std::string& version) {
    Opening opening;
    if (is_recovery(name)) {
        const Result<std::filesystem::path> file = recovery_file(state.options, name);
        if (!file.ok()) return file.error();
        Result<Recovered> recovered = read_recovery(file.value());
        if (!recovered.ok()) return recovered.error();
        return Opening{.document = std::move(recovered.value().document),
                       .name = recovered.value().scene,
                       .place = file.value().string(),
                       .is_unsaved = true,
                       .recovery = file.value(),
                       .lost = recovered.value().lost};
    }
    const bool is_version = !version.empty();
    const Result<std::filesystem::path> file =
        is_version ? version_file(state.options, name, version) : find_scene(state.options, name);
    if (!file.ok()) return file.error();
    Result<Document> document = load_document(file.value());
    if (!document.ok()) return document.error();
    return Opening{.document = std::move(document).value(),
                   .name = is_version ? name : name_of_scene(file.value()),
                   .place = file.value().string(),
                   .is_unsaved = is_version};
}

Result<Opening> read_opening(const SessionState& state, const json& params, bool& ask) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name, version, text, file_name = "text";
    const bool by_name = reader.text("name", name);
    reader.text("version", version);
    const json* scene = reader.take("scene");
    const bool by_text = reader.text("text", text);
    reader.text("file", file_name);
    reader.truth("ask", ask);
    if (!reader.finish()) return *error;
    if (int{by_name} + int{scene != nullptr} + int{by_text} != 1)
        return Error{"name", "say either a name, the scene itself, or the text of its file"};
    if (by_name) {
        Result<Opening> opening = read_named(state, name, version);
        if (opening.ok())
            opening.value().again = [name, version](const SessionState& now) { return read_named(now, name, version); };
        return opening;
    }

    // The document is in no file: its fields are fields of this command.
    if (scene) {
        Result<Document> document = document_from_json(*scene);
        if (document.ok()) return Opening{.document = std::move(document).value()};
        Error refused = document.error();
        refused.where = "scene" + (refused.where.empty() ? "" : "." + refused.where);
        return refused;
    }
    const Result<json> read = parse_json(text, file_name);
    if (!read.ok()) return read.error();
    Result<Document> document = document_from_json(read.value());
    if (!document.ok()) return in_place(file_name, document.error());
    return Opening{.document = std::move(document).value(), .place = file_name};
}

Result<json> load(SessionState& state, const json& params) {
    bool ask = true;
    Result<Opening> opening = read_opening(state, params, ask);
    if (!opening.ok()) return opening.error();
    return open_or_ask(state, std::move(opening).value(), ask);
}

// The camera that the scene will be opened with, where the page tells its own.
Result<std::optional<Camera>> read_camera(FieldReader& reader) {
    const json* given = reader.take("camera");
    if (!given) return std::optional<Camera>();
    Camera camera;
    FieldReader fields(*given, "camera", reader.error());
    read_fields(fields, camera);
    if (!fields.finish()) return *reader.error();
    return std::optional(camera);
}

Result<json> save(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name = state.name.empty() ? state.document.title : state.name;
    std::string version;
    reader.text("name", name);
    const bool has_version = reader.text("version", version);
    const Result<std::optional<Camera>> camera = read_camera(reader);
    if (!reader.finish()) return *error;
    name = trimmed_name(name);
    const Result<std::filesystem::path> file = saved_file(state.options, name);
    if (!file.ok()) return file.error();
    std::filesystem::path copy;
    if (has_version) {
        const Result<std::filesystem::path> found = version_file(state.options, name, version);
        if (!found.ok()) return found.error();
        copy = found.value();
        if (std::filesystem::exists(copy))
            return Error{"version", "there is a version “" + version + "” of this scene", "take another name"};
    }

    // Camera and title go with the file and are no step of undo.
    Heading heading = state.document;
    if (camera.value()) heading.camera = camera.value();
    if (name != state.name) heading.title = name;
    Heading before = std::exchange(static_cast<Heading&>(state.document), std::move(heading));
    Result<void> written = has_version ? save_document(state.document, copy) : Result<void>{};
    if (written.ok()) written = save_document(state.document, *file);
    if (!written.ok()) {
        // A version of a scene that is not saved would be in the way of the next try.
        std::error_code ignored;
        if (has_version) std::filesystem::remove(copy, ignored);
        static_cast<Heading&>(state.document) = std::move(before);
        return written.error();
    }
    state.name = name;
    state.mark_saved();
    state.tell_document(json::array({change_to_json(HeadingChange{}, state.document)}));
    return json{{"name", name}, {"path", file->string()}};
}

Result<json> list(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    if (!reader.finish()) return *error;
    return json{{"scenes", scenes_to_json(state.options)}};
}

Result<json> versions(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name = state.name;
    reader.text("name", name);
    if (!reader.finish()) return *error;
    json rows = json::array();
    if (!name.empty())
        for (const ListedScene& version : list_versions(state.options, name))
            rows.push_back({{"version", version.name}, {"modified", version.modified}});
    return json{{"versions", std::move(rows)}};
}

Result<json> discard(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name;
    need_text(reader, "name", "a recovered scene", name);
    if (!reader.finish()) return *error;
    const Result<std::filesystem::path> file = recovery_file(state.options, name);
    if (!file.ok()) return file.error();
    std::error_code problem;
    std::filesystem::remove(file.value(), problem);
    if (problem) return Error{file.value().string(), "can't be removed: " + problem.message()};
    return json::object();
}

// The fields of the document's heading, with those of its settings beside them.
Result<json> settings(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Edit edit = state.start_edit("Change settings");
    HeadingChange change{state.document, state.document};
    for_each_field<Heading>([&](const auto& field) {
        if constexpr (!std::is_same_v<typename std::remove_cvref_t<decltype(field)>::Member, physics::WorldSettings>)
            read_field(reader, field, *change.after);
    });
    read_fields(reader, change.after->settings);
    reader.text("merge", edit.merge);
    if (reader.finish()) check_value(reader, change.after->settings);
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
    static constexpr Command commands[] = {{"scene.new", make_new},
                                           {"scene.load", load},
                                           {"scene.save", save},
                                           {"scene.list", list, Need::look},
                                           {"scene.versions", versions, Need::look},
                                           {"scene.discard", discard},
                                           {"scene.settings", settings},
                                           {"edit.undo", undo},
                                           {"edit.redo", redo}};
    return commands;
}

}  // namespace embody::scene
