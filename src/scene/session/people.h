// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/document/history.h"
#include "scene/session/rights.h"
#include "scene/session/session.h"

namespace embody::scene {

/// A connected client, and what it said of itself.
struct Client {
    PersonId person = 0;     ///< whose steps of undo its edits are
    bool is_member = false;  ///< a page of the Studio: it gave a person
    bool is_greeted = false;
    Rights rights;
    std::string name;
    std::string color;                               ///< of a member, "#rrggbb"
    std::shared_ptr<const nlohmann::json> presence;  ///< what client.present told last; null: nothing
    std::shared_ptr<const nlohmann::json> untold;    ///< what the others have not been told of it yet
    std::chrono::steady_clock::time_point told_at;   ///< when they were told last
    std::optional<std::string> undo, redo;           ///< labels that it was told last
};

/// Who is connected (docs/session.md, "People").
class People {
public:
    /// The client, known or new; a new one is a person of its own.
    Client& client(ClientId id);
    /// Makes it a member that is the person of this text, the same as at an earlier connection. The error: it is
    /// another person already, or too many are known.
    Result<Client*> meet(ClientId id, const std::string& person, const History& history);
    /// Gives a member rights to edit and to run, which its person has also at a later connection. Returns all clients
    /// of that person.
    std::vector<ClientId> grant(ClientId id, bool edit, bool run);
    /// Whether it was a member.
    bool leave(ClientId id);

    [[nodiscard]] const std::map<ClientId, Client>& clients() const { return clients_; }
    [[nodiscard]] std::map<ClientId, Client>& clients() { return clients_; }
    /// Another scene is open: nobody is anywhere in it yet.
    void forget_presences();
    /// The other members.
    [[nodiscard]] std::vector<ClientId> others(ClientId id) const;
    /// For people: the client's name, or "Studio 3".
    [[nodiscard]] std::string called(ClientId id) const;
    /// For people: the name of a client that is this person, else "somebody who has left".
    [[nodiscard]] std::string person_called(PersonId person) const;
    /// The `members` of the protocol.
    [[nodiscard]] nlohmann::json members() const;

private:
    [[nodiscard]] std::string free_color() const;
    void forget_absent(const History& history);

    std::map<ClientId, Client> clients_;
    std::map<std::string, PersonId> persons_;  ///< by the text that the page keeps
    std::map<PersonId, Rights> granted_;       ///< of persons for whom somebody has said it
    PersonId last_person_ = 0;
};

}  // namespace embody::scene
