// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "foundation/result.h"

namespace embody::scene {

struct SessionState;

/// What a client may do besides looking (docs/session.md, "Rights").
struct Rights {
    bool edit = true;    ///< change the scene and the catalogue, open and save scenes
    bool run = true;     ///< play, pause, step and reset, and pull at what moves
    bool invite = true;  ///< bring others, and say what they may do

    bool operator==(const Rights&) const = default;
};

/// What a command needs of them.
enum class Need : std::uint8_t { look, run, edit };

/// Of the protocol: {"edit", "run", "invite"}.
nlohmann::json rights_to_json(const Rights& rights);

/// Refuses what the client of the command may not do, with who could allow it.
Result<void> check_rights(SessionState& state, Need need, const char* command);

/// Gives a member these rights to edit and to run, and tells everybody.
Result<void> set_rights(SessionState& state, std::uint64_t client, bool edit, bool run);

}  // namespace embody::scene
