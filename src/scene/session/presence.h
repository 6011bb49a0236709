// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>

#include "scene/session/session_state.h"

namespace embody::scene {

/// The command's client is there now as `news` says. The other members are told at most 20 times a second; what comes
/// faster is told together.
void take_presence(SessionState& state, const nlohmann::json& news, std::chrono::steady_clock::time_point now);
/// Tells what is waiting for its time; for a timer.
void tell_presences(SessionState& state, std::chrono::steady_clock::time_point now);
/// Tells the command's client, who has just come, how the others are there.
void tell_presences_of_others(SessionState& state);

}  // namespace embody::scene
