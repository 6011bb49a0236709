// SPDX-License-Identifier: MIT
#include "server/scene_thread.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "catalog/catalog.h"
#include "foundation/base64.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/text.h"
#include "scene/file/scene_file.h"
#include "scene/session/kept_forms.h"
#include "server/debug_board.h"
#include "server/state_frame.h"

namespace embody::server {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr auto statistics_period = std::chrono::milliseconds(250);
/// Longest time until a change of the database by another program is seen.
constexpr auto catalog_period = std::chrono::seconds(1);
/// After publishing, the next pause is at least so many times as long as the publishing took.
constexpr int publish_share = 4;
/// A command that takes longer reports its progress, with this period.
constexpr auto progress_period = std::chrono::milliseconds(150);
/// A machine that cannot keep up runs the scene slower than real time once it is so far behind.
constexpr double most_seconds_behind = 0.1;

std::string dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json failed(const json& id, const Error& error) {
    return {
        {"id", id}, {"ok", false}, {"error", {{"where", error.where}, {"why", error.why}, {"remedy", error.remedy}}}};
}

/// A client's command, or the news that it has come or left, or a request for the document (then only `take_document`
/// is set).
struct Message {
    ClientId client = 0;
    std::string text;
    std::function<void(scene::Document)> take_document;
    bool left = false;
    std::optional<scene::Rights> admitted = {};
};

}  // namespace

struct SceneThread::State {
    SceneThreadOptions options;
    SceneThreadListener listener;
    std::unique_ptr<catalog::Catalog> catalog;
    std::unique_ptr<scene::Session> session;

    mutable std::mutex mutex;  ///< guards messages, stop, ended, title, missing_models
    std::condition_variable changed;
    std::deque<Message> messages;
    bool stop = false, ended = false;
    StateBoard board;
    DebugBoard debug;
    std::string title;
    std::set<std::string> missing_models;

    std::thread thread;
    std::vector<scene::EntityState> scratch;
    Clock::time_point statistics_due{}, catalog_due{}, statistics_since{};
    Clock::time_point next_publish{}, next_debug{};
    bool publish_is_due = false;       ///< something may have changed since the last publish()
    ClientId served = 0;               ///< the client whose command is being executed
    Clock::time_point progress_due{};  ///< time of the next progress report
    double statistics_time = 0;        ///< simulated time at statistics_since
    bool statistics_rated = false;     ///< it has been playing since then

    Result<void> open_safely();
    Result<void> open();
    void run();
    void handle(const Message& message);
    json answer(const std::string& text);
    json execute(const json& request);
    json whole_frame(const json& id, const json& params);
    bool tell_progress(std::size_t done, std::size_t total);
    [[nodiscard]] bool stop_is_asked();
    [[nodiscard]] bool stop_is_requested() const;
    void follow_others();
    void tell_events();
    void note_missing_models();
    void publish(bool all_changed);
    void publish_if_due();
    void publish_debug();
    void tell_statistics(Clock::time_point now);
    void broadcast_message(const char* level, const std::string& text);
    void play_until(Clock::time_point& due);
};

SceneThread::SceneThread() : state_(std::make_unique<State>()) {}

SceneThread::~SceneThread() {
    request_stop();
    if (state_->thread.joinable()) state_->thread.join();
}

Result<std::unique_ptr<SceneThread>> SceneThread::start(const SceneThreadOptions& options,
                                                        SceneThreadListener listener) {
    std::unique_ptr<SceneThread> made(new SceneThread);
    State& state = *made->state_;
    state.options = options;
    state.options.session.stop_wanted = [&state] { return state.stop_is_requested(); };
    state.options.session.progress = [&state](std::size_t done, std::size_t total) {
        return state.tell_progress(done, total);
    };
    state.listener = std::move(listener);
    // The catalogue and the session are opened on the thread that uses them; this promise says whether that worked.
    std::promise<Result<void>> opened;
    std::future<Result<void>> result = opened.get_future();
    state.thread = std::thread([&state, opened = std::move(opened)]() mutable {
        Result<void> opening = state.open_safely();
        const bool ok = opening.ok();
        opened.set_value(std::move(opening));
        if (ok) state.run();
        const std::lock_guard lock(state.mutex);
        state.ended = true;
        state.changed.notify_all();
    });
    if (Result<void> opening = result.get(); !opening) return opening.error();
    return made;
}

void SceneThread::post(ClientId client, std::string message) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->messages.push_back({client, std::move(message), nullptr, false});
    }
    state_->changed.notify_all();
}

void SceneThread::admit(ClientId client, scene::Rights rights) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->messages.push_back({client, {}, nullptr, false, rights});
    }
    state_->changed.notify_all();
}

void SceneThread::forget(ClientId client) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->messages.push_back({client, {}, nullptr, true});
    }
    state_->changed.notify_all();
}

StateBoard::Frame SceneThread::frame_since(std::uint64_t seen) const { return state_->board.frame_since(seen); }

std::shared_ptr<const std::string> SceneThread::take_debug_frame(ClientId client) { return state_->debug.take(client); }

std::string SceneThread::scene_title() const {
    const std::lock_guard lock(state_->mutex);
    return state_->title;
}

std::set<std::string> SceneThread::missing_models() const {
    const std::lock_guard lock(state_->mutex);
    return state_->missing_models;
}

void SceneThread::request_document(std::function<void(scene::Document)> take) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->messages.push_back({0, {}, std::move(take), false});
    }
    state_->changed.notify_all();
}

void SceneThread::request_stop() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->stop = true;
    }
    state_->changed.notify_all();
}

bool SceneThread::wait_ended(Clock::time_point until) {
    std::unique_lock lock(state_->mutex);
    return state_->changed.wait_until(lock, until, [this] { return state_->ended; });
}

Result<void> SceneThread::State::open_safely() {
    try {
        return open();
    } catch (const std::exception& thrown) {
        return Error{options.open_scene, std::string("cannot be opened: ") + thrown.what(), ""};
    }
}

Result<void> SceneThread::State::open() {
    auto opened_catalog = catalog::Catalog::open(options.database, options.taxonomy_folder);
    if (!opened_catalog) return opened_catalog.error();
    catalog = std::move(*opened_catalog);
    auto created = scene::Session::create(catalog.get(), options.session);
    if (!created) return created.error();
    session = std::move(*created);
    if (!options.open_scene.empty()) {
        json params = {{"name", options.open_scene}};
        if (std::filesystem::is_regular_file(options.open_scene)) {
            auto document = scene::load_document(options.open_scene);
            if (!document) return document.error();
            params = {{"scene", scene::document_to_json(*document)}};
        }
        if (auto loaded = session->execute("scene.load", params); !loaded) {
            Error refused = loaded.error();
            if (params.contains("scene")) refused.where = options.open_scene + ": " + refused.where;
            return refused;
        }
    }
    tell_events();
    publish(true);
    return {};
}

void SceneThread::State::run() {
    Clock::time_point due = Clock::now();
    for (;;) {
        // Wait for a command, or until the next step is due.
        std::deque<Message> taken;
        {
            std::unique_lock lock(mutex);
            const auto ready = [this] { return stop || !messages.empty(); };
            if (session->playing())
                changed.wait_until(lock, due, ready);
            else
                changed.wait_until(lock, publish_is_due ? std::min(catalog_due, next_publish) : catalog_due, ready);
            taken.swap(messages);
            if (stop) break;
        }
        for (const Message& message : taken) {
            if (stop_is_requested()) break;
            handle(message);
        }
        if (stop_is_requested()) break;
        publish_if_due();
        if (session->playing())
            play_until(due);
        else
            due = Clock::now();
        if (Clock::now() >= catalog_due) follow_others();
    }
}

// Changes of the catalogue by other programs, and questions whose time is over.
void SceneThread::State::follow_others() {
    catalog_due = Clock::now() + catalog_period;
    try {
        session->follow_people(catalog_due);
        (void)session->follow_catalog();
        tell_events();
    } catch (const std::exception& thrown) {
        broadcast_message("warning", std::string("The database could not be followed: ") + thrown.what());
    }
}

bool SceneThread::State::tell_progress(std::size_t done, std::size_t total) {
    const Clock::time_point now = Clock::now();
    if (now < progress_due) return true;
    progress_due = now + progress_period;
    listener.broadcast(dump({{"event", "progress"}, {"client", served}, {"done", done}, {"total", total}}));
    return !stop_is_asked();
}

// Whether the server ends.
bool SceneThread::State::stop_is_requested() const {
    const std::lock_guard lock(mutex);
    return stop;
}

// Whether the server ends, or the client's next command asks to stop.
bool SceneThread::State::stop_is_asked() {
    const std::lock_guard lock(mutex);
    return stop || std::any_of(messages.begin(), messages.end(), [this](const Message& message) {
               if (message.client != served || message.take_document) return false;
               if (message.left || message.text.size() > 200) return message.left;
               const json request = json::parse(message.text, nullptr, false);
               return request.is_object() && request.value("command", json()) == "catalog.stop";
           });
}

void SceneThread::State::broadcast_message(const char* level, const std::string& text) {
    listener.broadcast(dump({{"event", "message"}, {"level", level}, {"text", text}}));
}

void SceneThread::State::play_until(Clock::time_point& due) {
    const Clock::time_point now = Clock::now();
    if (now < due) return;
    const auto step = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(session->time_step() / session->rate()));
    try {
        session->step();
    } catch (const std::exception& thrown) {
        // The document is unchanged: it can still be edited and saved.
        (void)session->execute("simulation.pause", {});
        broadcast_message("error", std::string("The simulation could not go on: ") + thrown.what());
    }
    due += step;
    const auto most_behind =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(most_seconds_behind));
    due = std::max(due, now - most_behind);
    tell_events();
    publish(false);
    if (now >= statistics_due || !session->playing()) tell_statistics(now);
}

void SceneThread::State::tell_statistics(Clock::time_point now) {
    json statistics = session->statistics();
    const double wall = std::chrono::duration<double>(now - statistics_since).count();
    const double simulated = session->simulated_time() - statistics_time;
    // While paused, single steps would show how fast a person presses a key.
    const bool has_rate = statistics_rated && wall > 0 && simulated >= 0;
    statistics["real_time_factor"] = has_rate ? simulated / wall : 0.0;
    statistics_rated = session->playing();
    statistics_since = now;
    statistics_time = session->simulated_time();
    statistics_due = now + statistics_period;
    listener.broadcast(dump(statistics));
}

void SceneThread::State::handle(const Message& message) {
    if (message.take_document) return message.take_document(session->document());
    if (message.admitted) return session->admit(message.client, *message.admitted);
    if (message.left) {
        debug.forget(message.client);
        session->forget_client(message.client);
        return tell_events();
    }
    const bool was_playing = session->playing();
    const std::uint64_t step_before = session->simulated_steps();
    served = message.client;
    progress_due = Clock::now() + progress_period;
    const json reply = answer(message.text);
    // Events first, so that a client that receives its reply already knows what the command did.
    tell_events();
    listener.reply(message.client, dump(reply));
    if (session->playing() != was_playing || session->simulated_steps() != step_before) tell_statistics(Clock::now());
}

json SceneThread::State::answer(const std::string& text) {
    // An exception of a library (memory, files) fails this command and nothing else.
    try {
        const Result<json> request = scene::parse_json(text, "message");
        if (!request) return failed(nullptr, request.error());
        if (!request->is_object())
            return failed(nullptr, {"message", "is not a JSON object", R"(send {"id": 1, "command": "hello"})"});
        return execute(*request);
    } catch (const std::exception& thrown) {
        return failed(nullptr, {"message", std::string("could not be carried out: ") + thrown.what(), ""});
    }
}

json SceneThread::State::execute(const json& request) {
    const json id = request.value("id", json());
    if (!id.is_number_integer()) return failed(nullptr, {"id", "must be an integer", "number your commands"});
    for (const auto& [field, value] : request.items()) {
        if (field != "id" && field != "command" && field != "params")
            return failed(id, {field, "is no field of a command", "use id, command and params"});
    }
    const json command = request.value("command", json());
    if (!command.is_string()) return failed(id, {"command", "must be a string", ""});
    const json params = request.value("params", json::object());
    if (!params.is_object()) return failed(id, {"params", "must be an object", ""});
    if (command == "debug.draw") {
        if (auto chosen = debug.choose(served, params); !chosen) return failed(id, chosen.error());
        publish_is_due = true;
        next_debug = {};
        return {{"id", id}, {"ok", true}, {"result", json::object()}};
    }
    if (command == "time.frame") return whole_frame(id, params);
    auto result = session->execute(command.get<std::string>(), params, served);
    if (!result) return failed(id, result.error());
    if (command == "hello" && options.greeting) {
        const json& rights = (*result)["rights"];
        result->update(options.greeting({rights["edit"], rights["run"], rights["invite"]}));
    }
    return {{"id", id}, {"ok", true}, {"result", std::move(*result)}};
}

// One frame of everything, now or at a time of the take, for this client alone: films are drawn from these.
json SceneThread::State::whole_frame(const json& id, const json& params) {
    std::optional<Error> error;
    scene::FieldReader reader(params, "", error);
    std::optional<double> time;
    double asked = 0;
    if (reader.number("time", asked, {0, 1e9})) time = asked;
    if (!reader.finish()) return failed(id, *error);
    std::vector<scene::EntityState> states;
    scene::Moment moment;
    session->read_states_at(time, states, moment);
    const bool is_past = time && !moment.entities.empty();
    StateBoard whole;
    whole.publish(states, is_past ? moment.time : session->simulated_time(),
                  is_past ? moment.step : session->simulated_steps(), true);
    json spawned = json::array();
    for (const scene::EntityState& state : states)
        if (const scene::Entity* entity = session->spawned(state.entity))
            scene::tell_in_short(spawned.emplace_back(scene::entity_to_json(*entity)));
    json result = {{"frame", to_base64(whole.frame_since(0).bytes)}, {"spawned", std::move(spawned)}};
    return {{"id", id}, {"ok", true}, {"result", std::move(result)}};
}

void SceneThread::State::note_missing_models() {
    std::set<std::string> missing = session->missing_models();
    const std::lock_guard lock(mutex);
    missing_models = std::move(missing);
}

void SceneThread::State::tell_events() {
    scene::Events events = session->take_events();
    bool document_changed = false;
    for (const json& event : events.messages) {
        const std::string name = event.value("event", "");
        document_changed = document_changed || name == "document";
        if (name == "waiting") note_missing_models();
        listener.broadcast(dump(event));
    }
    for (const auto& [client, event] : events.directed) listener.send(client, dump(event));
    if (events.all_poses) return publish(true);
    if (document_changed || !session->playing()) publish_is_due = true;
    publish_if_due();
}

// While the scene plays, drawing too is limited to a fraction of the time; else publish() limits it.
void SceneThread::State::publish_debug() {
    const Clock::time_point began = Clock::now();
    if (!debug.is_wanted() || (session->playing() && began < next_debug)) return;
    debug.publish(*session);
    next_debug = Clock::now() + publish_share * (Clock::now() - began);
}

// The walk over all entities is limited to a fraction of the time, however many commands follow each other.
void SceneThread::State::publish_if_due() {
    if (publish_is_due && Clock::now() >= next_publish) publish(false);
}

void SceneThread::State::publish(bool all_changed) {
    const Clock::time_point began = Clock::now();
    session->read_states(scratch);
    board.publish(scratch, session->simulated_time(), session->simulated_steps(), all_changed);
    publish_debug();
    {
        const std::lock_guard lock(mutex);
        title = session->document().title;
    }
    listener.states_changed();
    publish_is_due = false;
    next_publish = Clock::now() + publish_share * (Clock::now() - began);
}

}  // namespace embody::server
