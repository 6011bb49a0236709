// SPDX-License-Identifier: MIT
// What clients' hands feel, and what is heard of impacts.
#include <nlohmann/json.hpp>

#include "scene/file/json/parts.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr double audible_speed = 0.05;  // m/s: what meets more slowly is laid down without a sound

}  // namespace

void SessionState::forget_hands(ClientId who) {
    hands.forget(*simulation, who);
    impact_listeners.erase(who);
}

void SessionState::tell_strikes() {
    const auto index_json = [](EntityIndex index) { return index != 0 ? json(index) : json(nullptr); };
    for (const Strike& strike : hands.after_step(*simulation))
        tell_to(strike.hand.client, {{"event", "hand"},
                                     {"hand", strike.hand.name},
                                     {"impulse", strike.impulse},
                                     {"index", index_json(strike.held)},
                                     {"other", index_json(strike.other)},
                                     {"position", vector_to_json(strike.position)}});
}

void SessionState::tell_impacts() {
    if (impact_listeners.empty() || play_state != PlayState::playing) return;
    const auto is_audible = [](const physics::ContactEvent& event) {
        return event.user_data_a != event.user_data_b && event.approach_speed >= audible_speed;
    };
    impacts.add(new_impacts(*simulation, is_audible));
    if (impacts.empty() || !impact_pace.is_due(simulation->world().last_report().time)) return;
    const auto index_json = [this](physics::BodyHandle body) {
        const EntityIndex index = simulation->entity(body);
        return index != 0 ? json(index) : json(nullptr);
    };
    json list = json::array();
    for (const Impact& impact : impacts.take())
        list.push_back({{"position", vector_to_json(impact.position)},
                        {"impulse", impact.impulse},
                        {"a", index_json(impact.a)},
                        {"b", index_json(impact.b)}});
    for (const ClientId listener : impact_listeners) tell_to(listener, {{"event", "impacts"}, {"impacts", list}});
}

}  // namespace embody::scene
