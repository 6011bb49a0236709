// SPDX-License-Identifier: MIT
#include "scene/session/people.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace embody::scene {

using nlohmann::json;

namespace {

/// Colours that people with any colour vision can tell apart (Okabe and Ito, "Color universal design", 2008), without
/// black and without the yellow that is lost on a light background.
constexpr std::array<const char*, 6> palette = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
/// Persons that are remembered; of more, those who are not connected and have no steps are forgotten.
constexpr std::size_t max_persons = 1000;

}  // namespace

Client& People::client(ClientId id) {
    const auto [found, is_new] = clients_.try_emplace(id);
    // The program itself is person 0.
    if (is_new && id != 0) found->second.person = ++last_person_;
    return found->second;
}

Result<Client*> People::meet(ClientId id, const std::string& person, const History& history) {
    Client& met = client(id);
    if (met.is_member) {
        const auto known = persons_.find(person);
        if (known != persons_.end() && known->second == met.person) return &met;
        return Error{"person", "this connection is another person already", "open a connection for each person"};
    }
    if (!persons_.contains(person)) {
        if (persons_.size() >= max_persons) forget_absent(history);
        if (persons_.size() >= max_persons) return Error{"person", "too many people have been here", "leave it out"};
        persons_.emplace(person, ++last_person_);
    }
    met.person = persons_.at(person);
    met.color = free_color();
    met.is_member = true;
    if (const auto granted = granted_.find(met.person); granted != granted_.end() && !met.rights.invite)
        met.rights = granted->second;
    return &met;
}

std::vector<ClientId> People::grant(ClientId id, bool edit, bool run) {
    const PersonId person = client(id).person;
    granted_[person] = {edit, run, false};
    std::vector<ClientId> changed;
    for (auto& [other, client] : clients_) {
        if (client.person != person || client.rights.invite) continue;
        client.rights = granted_[person];
        changed.push_back(other);
    }
    return changed;
}

// Those who are not connected, have nothing to undo or redo, and whose rights nobody has changed.
void People::forget_absent(const History& history) {
    std::erase_if(persons_, [&](const auto& known) {
        const PersonId person = known.second;
        return !history.undoable(person) && !history.redoable(person) && !granted_.contains(person) &&
               std::none_of(clients_.begin(), clients_.end(),
                            [person](const auto& other) { return other.second.person == person; });
    });
}

bool People::leave(ClientId id) {
    const auto found = clients_.find(id);
    if (found == clients_.end()) return false;
    const bool was_member = found->second.is_member;
    clients_.erase(found);
    return was_member;
}

void People::forget_presences() {
    for (auto& [id, client] : clients_) client.presence = client.untold = nullptr;
}

// The first colour that the fewest members have.
std::string People::free_color() const {
    const auto uses = [this](const char* color) {
        return std::count_if(clients_.begin(), clients_.end(),
                             [color](const auto& other) { return other.second.color == color; });
    };
    return *std::min_element(palette.begin(), palette.end(),
                             [&](const char* a, const char* b) { return uses(a) < uses(b); });
}

std::vector<ClientId> People::others(ClientId id) const {
    std::vector<ClientId> found;
    for (const auto& [other, client] : clients_)
        if (other != id && client.is_member) found.push_back(other);
    return found;
}

std::string People::called(ClientId id) const {
    const auto found = clients_.find(id);
    if (found != clients_.end() && !found->second.name.empty()) return found->second.name;
    return "Studio " + std::to_string(id);
}

std::string People::person_called(PersonId person) const {
    const auto found = std::find_if(clients_.begin(), clients_.end(),
                                    [person](const auto& client) { return client.second.person == person; });
    return found == clients_.end() ? "somebody who has left" : called(found->first);
}

json People::members() const {
    json members = json::array();
    for (const auto& [id, client] : clients_)
        if (client.is_member)
            members.push_back({{"client", id},
                               {"name", called(id)},
                               {"color", client.color},
                               {"rights", rights_to_json(client.rights)}});
    return members;
}

}  // namespace embody::scene
