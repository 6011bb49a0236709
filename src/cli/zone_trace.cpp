// SPDX-License-Identifier: MIT
#include "cli/zone_trace.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "foundation/zone.h"

namespace embody::cli {
namespace {

using nlohmann::json;

constexpr int process = 1;  // process id in the trace; there is only one

double microseconds(ZoneClock::duration time) { return std::chrono::duration<double, std::micro>(time).count(); }

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json thread_name(std::uint32_t thread, const std::string& name) {
    return {{"ph", "M"}, {"name", "thread_name"}, {"pid", process}, {"tid", thread}, {"args", {{"name", name}}}};
}

}  // namespace

struct ZoneTrace::State {
    std::filesystem::path path;
    std::ofstream file;
    std::map<std::uint32_t, std::string> threads;
    std::unique_ptr<ZoneRecording> recording;

    [[nodiscard]] Error cannot_write() const {
        return {path.string(), std::string("cannot be written: ") + std::strerror(errno),
                "choose a file in a folder that exists, that you may write to, and that has room"};
    }
};

ZoneTrace::ZoneTrace() : state_(std::make_unique<State>()) {}
ZoneTrace::~ZoneTrace() = default;

Result<std::unique_ptr<ZoneTrace>> ZoneTrace::create(const std::filesystem::path& file) {
    std::unique_ptr<ZoneTrace> trace(new ZoneTrace);
    State& state = *trace->state_;
    state.path = file;
    state.file.open(file, std::ios::trunc);
    state.file << R"({"displayTimeUnit":"ms","traceEvents":[)" << '\n'
               << text_of({{"ph", "M"}, {"name", "process_name"}, {"pid", process}, {"args", {{"name", "embody"}}}});
    if (!state.file.flush()) return state.cannot_write();
    name_zone_thread("main");
    state.recording = std::make_unique<ZoneRecording>();
    return trace;
}

Result<void> ZoneTrace::take() {
    State& state = *state_;
    state.recording->take([&](const ZoneThread& thread, const ZoneRecord& zone) {
        state.threads.try_emplace(thread.number, thread.name);
        state.file << ",\n"
                   << text_of({{"ph", "X"},
                               {"name", zone.name},
                               {"pid", process},
                               {"tid", thread.number},
                               {"ts", microseconds(zone.begin - state.recording->start())},
                               {"dur", microseconds(zone.end - zone.begin)}});
    });
    if (!state.file) return state.cannot_write();
    return {};
}

Result<std::uint64_t> ZoneTrace::finish() {
    if (auto taken = take(); !taken) return taken.error();
    State& state = *state_;
    const std::uint64_t dropped = state.recording->dropped();
    state.recording.reset();
    for (const auto& [thread, name] : state.threads) state.file << ",\n" << text_of(thread_name(thread, name));
    state.file << "\n],\"otherData\":" << text_of({{"dropped_zones", dropped}}) << "}\n";
    state.file.close();
    if (!state.file) return state.cannot_write();
    return dropped;
}

}  // namespace embody::cli
