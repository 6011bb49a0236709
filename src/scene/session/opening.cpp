// SPDX-License-Identifier: MIT
#include "scene/session/opening.h"

#include <nlohmann/json.hpp>

#include "scene/document/document_field.h"
#include "scene/session/session_state.h"

namespace embody::scene {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

namespace {

/// Who has not answered in this time agrees.
constexpr auto answer_time = std::chrono::seconds(20);

// A journal that is open now is not needed any more. One with a damaged line may have more in it than could be read.
void put_away(SessionState& state, const Opening& opening) {
    if (opening.recovery.empty()) return;
    std::error_code ignored;
    if (opening.lost > 0) {
        std::filesystem::path kept = opening.recovery;
        kept += ".damaged";
        std::filesystem::rename(opening.recovery, kept, ignored);
        state.tell_message("warning", std::to_string(opening.lost) +
                                          " edits behind a damaged line could not be read; the file is kept as " +
                                          kept.string());
    } else if (state.journal) {
        std::filesystem::remove(opening.recovery, ignored);
    }
}

Result<void> open_now(SessionState& state, Opening opening) {
    if (Result<void> opened = state.open(std::move(opening.document), opening.name, opening.is_unsaved); !opened.ok())
        return in_place(opening.place, opened.error());
    put_away(state, opening);
    return {};
}

// Everybody can close the question.
Opening end_question(SessionState& state) {
    Opening opening = std::move(state.question->opening);
    state.tell({{"event", "question_over"}, {"question", state.question->number}});
    state.question.reset();
    return opening;
}

}  // namespace

Result<json> open_or_ask(SessionState& state, Opening opening, bool may_ask) {
    // Who may only look has no hands in the scene that it would be taken from.
    std::vector<ClientId> others = state.people.others(state.client);
    std::erase_if(others, [&state](ClientId other) { return !state.people.client(other).rights.edit; });
    if (!may_ask || others.empty()) {
        if (Result<void> opened = open_now(state, std::move(opening)); !opened.ok()) return opened.error();
        // Another scene is open now: whoever was asked about one would be asked about a scene that has gone.
        if (state.question) end_question(state);
        return json::object();
    }
    if (!state.people.client(state.client).is_member)
        return Error{"scene", "other people have their scene open here", "ask: false opens another one all the same"};
    if (state.question)
        return Error{"scene", state.people.called(state.question->asker) + " is asking already to open another scene",
                     "wait for the answer"};
    Question question;
    question.number = ++state.last_question;
    question.asker = state.client;
    question.waiting = {others.begin(), others.end()};
    question.until = Clock::now() + answer_time;
    const std::string title = opening.document.title;
    question.opening = std::move(opening);
    const std::string name = state.people.called(state.client);
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(answer_time).count();
    for (const ClientId other : others)
        state.tell_to(other, {{"event", "question"},
                              {"question", question.number},
                              {"client", state.client},
                              {"name", name},
                              {"title", title},
                              {"seconds", seconds},
                              {"text", name + " would like to open “" + title + "” for everybody"}});
    json result = {{"asked", others}, {"question", question.number}, {"seconds", seconds}};
    state.question = std::move(question);
    return result;
}

Result<void> answer_question(SessionState& state, std::uint64_t number, bool agrees) {
    if (!state.question || state.question->number != number)
        return Error{"question", "there is no question " + std::to_string(number) + " any more"};
    if (state.client != state.question->asker && !state.question->waiting.contains(state.client))
        return Error{"question", "you were not asked, or have answered"};
    if (agrees) {
        state.question->waiting.erase(state.client);
        follow_question(state, Clock::now());
        return {};
    }
    const ClientId asker = state.question->asker;
    const std::string title = state.question->opening.document.title;
    end_question(state);
    if (asker != state.client)
        state.tell_to(asker, {{"event", "message"},
                              {"level", "warning"},
                              {"text", state.people.called(state.client) + " would rather go on here; “" + title +
                                           "” was not opened"}});
    return {};
}

void withdraw_question(SessionState& state) { end_question(state); }

void follow_question(SessionState& state, Clock::time_point now) {
    if (!state.question) return;
    std::erase_if(state.question->waiting,
                  [&state](ClientId client) { return !state.people.clients().contains(client); });
    const bool asker_left = !state.people.clients().contains(state.question->asker);
    if (!asker_left && !state.question->waiting.empty() && now < state.question->until) return;
    const ClientId asker = state.question->asker;
    Result<Opening> opening = end_question(state);
    // Who asked has left: nobody wants it any more.
    if (!state.people.clients().contains(asker)) return;
    if (opening.value().again) opening = opening.value().again(state);
    const Result<void> opened = opening.ok() ? open_now(state, std::move(opening).value()) : opening.error();
    if (!opened.ok())
        state.tell_to(asker, {{"event", "message"}, {"level", "error"}, {"text", opened.error().message()}});
}

}  // namespace embody::scene
