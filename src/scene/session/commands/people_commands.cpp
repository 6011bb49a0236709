// SPDX-License-Identifier: MIT
// Who is connected, what they do, and what they are asked (docs/session.md, "People").
#include <algorithm>
#include <nlohmann/json.hpp>

#include "foundation/version.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/session/catalog_edit.h"
#include "scene/session/commands/commands.h"
#include "scene/session/kept_forms.h"
#include "scene/session/presence.h"
#include "scene/session/scene_folders.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr int frame_version = 2;
constexpr std::size_t max_name_bytes = 160;
constexpr std::size_t max_person_bytes = 64;
/// Of a larger selection the others are told so many.
constexpr std::size_t max_told_selection = 1000;
constexpr std::size_t max_hands = 2;

// Makes the client known, as the person that it says it is.
Result<Client*> greet(SessionState& state, const std::optional<std::string>& person) {
    Client& client = state.people.client(state.client);
    const bool was_member = client.is_member;
    if (person)
        if (Result<Client*> met = state.people.meet(state.client, *person, state.history); !met.ok()) return met;
    client.is_greeted = true;
    const auto label = [](const Edit* edit) { return edit ? std::optional(edit->label) : std::nullopt; };
    client.undo = label(state.history.undoable(client.person));
    client.redo = label(state.history.redoable(client.person));
    if (!client.is_member || was_member) return &client;
    state.tell({{"event", "members"}, {"members", state.people.members()}});
    tell_presences_of_others(state);
    return &client;
}

// Everything that a client needs to draw the scene and to follow it.
Result<json> hello(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::optional<std::string> person;
    if (std::string text; reader.text("person", text)) person = text;
    if (!reader.finish()) return *error;
    if (person && (person->empty() || person->size() > max_person_bytes))
        return Error{"person", "must have 1 … " + std::to_string(max_person_bytes) + " bytes"};
    const Result<Client*> greeted = greet(state, person);
    if (!greeted.ok()) return greeted.error();
    const Client& client = *greeted.value();

    // Entities in the world but not in the document, and the reverse.
    json spawned = json::array(), despawned = json::array();
    const std::vector<EntityIndex> shown = state.shown_entities();
    for (const EntityIndex index : shown)
        if (const auto found = state.past.spawned.find(index); found != state.past.spawned.end())
            tell_in_short(spawned.emplace_back(entity_to_json(found->second.entity)));
    for (const Entity& entity : state.document.entities)
        if (!std::ranges::binary_search(shown, entity.index) && !state.simulation->is_waiting(entity.index))
            despawned.push_back(entity.index);
    const auto value = [](const std::optional<std::string>& text) { return text ? json(*text) : json(nullptr); };
    json scene = document_to_json(state.document);
    tell_scene_in_short(scene);
    return json{{"version", version_text},
                {"scene", std::move(scene)},
                {"revision", state.revision},
                {"simulation", state.simulation_json()},
                {"take", state.take_json()},
                {"frame_version", frame_version},
                {"undo", value(client.undo)},
                {"redo", value(client.redo)},
                {"unsaved", !state.history.is_saved()},
                {"name", state.name},
                {"client", state.client},
                {"members", state.people.members()},
                {"rights", rights_to_json(client.rights)},
                {"recovered", recoveries_to_json(state.options)},
                {"kept", !state.is_unkept},
                {"spawned", std::move(spawned)},
                {"despawned", std::move(despawned)},
                {"waiting", state.simulation->waiting()}};
}

Result<json> set_name(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name;
    need_text(reader, "name", "your name, or nothing", name);
    if (!reader.finish()) return *error;
    const auto is_control = [](unsigned char byte) { return byte < 0x20 || byte == 0x7f; };
    if (std::any_of(name.begin(), name.end(), is_control)) return Error{"name", "must be one line of text"};
    name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
    name.erase(name.find_last_not_of(' ') + 1);
    if (name.size() > max_name_bytes)
        return Error{"name", "is longer than " + std::to_string(max_name_bytes) + " bytes", "shorten it"};
    Client& client = state.people.client(state.client);
    const bool is_new = client.name != name;
    client.name = std::move(name);
    if (is_new && client.is_member) state.tell({{"event", "members"}, {"members", state.people.members()}});
    return json{{"session", acting_session(state)}};
}

// Presence
// -------------------------------------------------------------------------------------------------------------

// Reads an object of a position and, where `is_turned`, a rotation, or null: nothing is there.
json read_place(FieldReader& reader, const char* name, const json& value, bool is_turned) {
    if (value.is_null()) return nullptr;
    FieldReader place(value, reader.path(name), reader.error());
    Vec3 position;
    Quat rotation;
    need_vector(place, "position", "where, [x, y, z]", position);
    if (is_turned) place.rotation("rotation", rotation);
    place.finish();
    json read = {{"position", vector_to_json(position)}};
    if (is_turned) read["rotation"] = rotation_to_json(rotation);
    return read;
}

json read_camera(FieldReader& reader, const json& value) {
    FieldReader camera(value, reader.path("camera"), reader.error());
    Vec3 position, target;
    need_vector(camera, "position", "where the eye is", position);
    need_vector(camera, "target", "what it looks at", target);
    camera.finish();
    return {{"position", vector_to_json(position)}, {"target", vector_to_json(target)}};
}

json read_selection(FieldReader& reader, const json& list) {
    const std::string where = reader.path("selection");
    json read = json::array();
    if (!read_array(list, where, reader.error())) return read;
    for (std::size_t i = 0; i < std::min(list.size(), max_told_selection); ++i) {
        double number = 0;
        if (!read_number(list[i], element_path(where, i), number, reader.error(), {1, 4294967295.0})) break;
        read.push_back(static_cast<std::uint32_t>(number));
    }
    return read;
}

json read_hands(FieldReader& reader, const json& list) {
    const std::string where = reader.path("hands");
    json read = json::array();
    if (!read_array(list, where, reader.error())) return read;
    if (list.size() > max_hands) reader.fail(where, "are more than two");
    for (std::size_t i = 0; i < list.size() && reader.ok(); ++i) {
        FieldReader item(list[i], element_path(where, i), reader.error());
        std::string hand;
        Vec3 position;
        Quat rotation;
        std::uint32_t holds = 0;
        need_text(item, "hand", "\"left\" or \"right\"", hand);
        if (item.ok() && hand != "left" && hand != "right")
            item.fail(item.path("hand"), "is neither \"left\" nor \"right\"");
        need_vector(item, "position", "where, [x, y, z]", position);
        item.rotation("rotation", rotation);
        item.whole("holds", holds);
        if (!item.finish()) break;
        read.push_back(
            {{"hand", hand}, {"position", vector_to_json(position)}, {"rotation", rotation_to_json(rotation)}});
        if (holds != 0) read.back()["holds"] = holds;
    }
    return read;
}

// The newest presence is kept whole, for members who come later; the others are told what has changed.
Result<json> present(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    json told = json::object();
    if (const json* selection = reader.take("selection")) told["selection"] = read_selection(reader, *selection);
    if (const json* camera = reader.take("camera")) told["camera"] = read_camera(reader, *camera);
    if (const json* pointer = reader.take("pointer")) told["pointer"] = read_place(reader, "pointer", *pointer, false);
    if (const json* head = reader.take("head")) told["head"] = read_place(reader, "head", *head, true);
    if (const json* hands = reader.take("hands")) told["hands"] = read_hands(reader, *hands);
    if (std::string mode; reader.text("mode", mode)) {
        if (mode != "page" && mode != "headset") reader.fail("mode", "is neither \"page\" nor \"headset\"");
        told["mode"] = mode;
    }
    if (!reader.finish()) return *error;
    if (!state.people.client(state.client).is_member)
        return Error{"client.present", "is for members", "say hello with a person first"};
    take_presence(state, told, std::chrono::steady_clock::now());
    return json::object();
}

Result<json> answer(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t number = 0;
    bool agrees = false;
    if (reader.need("question", "the number of the question")) reader.whole("question", number, 1);
    if (reader.need("agrees", "yes or no")) reader.truth("agrees", agrees);
    if (!reader.finish()) return *error;
    return done(answer_question(state, number, agrees));
}

Result<json> change_rights(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t client = 0;
    bool edit = false, run = false;
    if (reader.need("client", "the number of a member")) reader.whole("client", client, 1);
    if (reader.need("edit", "whether it may edit")) reader.truth("edit", edit);
    if (reader.need("run", "whether it may run the simulation")) reader.truth("run", run);
    if (!reader.finish()) return *error;
    return done(set_rights(state, client, edit, run));
}

}  // namespace

std::span<const Command> people_commands() {
    static constexpr Command commands[] = {{"hello", hello, Need::look},
                                           {"client.set_name", set_name, Need::look},
                                           {"client.present", present, Need::look},
                                           {"scene.answer", answer, Need::look},
                                           {"client.set_rights", change_rights, Need::look}};
    return commands;
}

}  // namespace embody::scene
