// SPDX-License-Identifier: MIT
#include "scene/session/presence.h"

#include <memory>
#include <nlohmann/json.hpp>

namespace embody::scene {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

namespace {

/// Heads and hands glide between two of these.
constexpr auto presence_period = std::chrono::milliseconds(50);

json event_of(ClientId client, json presence) {
    presence["event"] = "presence";
    presence["client"] = client;
    return presence;
}

json merged(const std::shared_ptr<const json>& before, const json& news) {
    json whole = before ? *before : json::object();
    whole.update(news);
    return whole;
}

void tell_waiting(SessionState& state, ClientId id, Client& client, Clock::time_point now) {
    if (!client.untold || now < client.told_at + presence_period) return;
    const json event = event_of(id, *client.untold);
    for (const ClientId other : state.people.others(id)) state.tell_to(other, event);
    client.untold = nullptr;
    client.told_at = now;
}

}  // namespace

void take_presence(SessionState& state, const json& news, Clock::time_point now) {
    Client& client = state.people.client(state.client);
    client.presence = std::make_shared<const json>(merged(client.presence, news));
    client.untold = std::make_shared<const json>(merged(client.untold, news));
    tell_waiting(state, state.client, client, now);
}

void tell_presences(SessionState& state, Clock::time_point now) {
    for (auto& [id, client] : state.people.clients()) tell_waiting(state, id, client, now);
}

void tell_presences_of_others(SessionState& state) {
    for (const ClientId other : state.people.others(state.client))
        if (const auto presence = state.people.client(other).presence)
            state.tell_to(state.client, event_of(other, *presence));
}

}  // namespace embody::scene
