// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/session/session.h"

namespace embody::scene {

struct SessionState;

/// A document that was read and is to become the open one.
struct Opening {
    Document document;
    std::string name;                ///< of its file; empty: not saved yet
    std::string place;               ///< what refusals by physics call it; empty: nothing
    bool is_unsaved = false;         ///< it is in no file of that name
    std::filesystem::path recovery;  ///< the journal that it was read from; removed once it is open
    std::size_t lost = 0;            ///< edits of the journal that could not be read
    /// Reads it again where it is in a file: that may have changed while people were asked. May be empty.
    std::function<Result<Opening>(const SessionState&)> again;
};

/// An opening that the other members are asked about (docs/session.md).
struct Question {
    std::uint64_t number = 0;
    ClientId asker = 0;
    Opening opening;
    std::set<ClientId> waiting;  ///< who has not answered
    std::chrono::steady_clock::time_point until;
};

/// Opens the document, or asks the other members first where there are any; the value is the command's result.
Result<nlohmann::json> open_or_ask(SessionState& state, Opening opening, bool may_ask);
/// The command scene.answer of the client whose command is being executed.
Result<void> answer_question(SessionState& state, std::uint64_t number, bool agrees);
/// Ends the question that is open; nothing is opened.
void withdraw_question(SessionState& state);
/// Opens what was asked about once nobody is left to answer, or the time is over; for a timer and when a member leaves.
void follow_question(SessionState& state, std::chrono::steady_clock::time_point now);

}  // namespace embody::scene
