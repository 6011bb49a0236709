// SPDX-License-Identifier: MIT
#include "scene/session/rights.h"

#include <nlohmann/json.hpp>

#include "scene/session/opening.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// A member who could allow it, for people.
std::string who_invites(const People& people) {
    for (const auto& [id, client] : people.clients())
        if (client.is_member && client.rights.invite) return people.called(id);
    return "whoever started Embody";
}

std::string in_words(const Rights& rights) {
    if (rights.edit && rights.run) return "edit and run the scene";
    if (rights.edit) return "edit the scene, but not run it";
    if (rights.run) return "run the scene, but not edit it";
    return "look, but neither edit nor run the scene";
}

}  // namespace

json rights_to_json(const Rights& rights) {
    return {{"edit", rights.edit}, {"run", rights.run}, {"invite", rights.invite}};
}

Result<void> check_rights(SessionState& state, Need need, const char* command) {
    const auto known = state.people.clients().find(state.client);
    if (need == Need::look || known == state.people.clients().end()) return {};
    const Rights& rights = known->second.rights;
    if (need == Need::edit ? rights.edit : rights.run) return {};
    return Error{command, "is not allowed: you may " + in_words(rights), "ask " + who_invites(state.people)};
}

Result<void> set_rights(SessionState& state, ClientId client, bool edit, bool run) {
    People& people = state.people;
    if (!people.client(state.client).rights.invite)
        return Error{"client.set_rights", "is for those who came by the host's own address",
                     "ask " + who_invites(people)};
    const auto found = people.clients().find(client);
    if (found == people.clients().end() || !found->second.is_member)
        return Error{"client", "Studio " + std::to_string(client) + " is not here any more"};
    if (found->second.rights.invite)
        return Error{"client", people.called(client) + " came by the host's own address, and may do everything",
                     "start Embody anew for another address, and give guests one of theirs"};
    for (const ClientId changed : people.grant(client, edit, run)) {
        if (!run) state.hands.forget(*state.simulation, changed);
        // Nobody opens a scene by a question from the time when they still could.
        if (!edit && state.question && state.question->asker == changed) withdraw_question(state);
        state.tell_to(changed,
                      {{"event", "message"},
                       {"level", "info"},
                       {"text", people.called(state.client) + ": you may " + in_words(people.client(changed).rights)}});
    }
    state.tell({{"event", "members"}, {"members", people.members()}});
    return {};
}

}  // namespace embody::scene
