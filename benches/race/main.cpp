// SPDX-License-Identifier: MIT
//
// The program that `embody bench race` runs, separate from embody, which therefore never links another engine.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "benches/race/report.h"

namespace embody::race {
namespace {

// The same codes as the other commands: a wrong result fails, and so do wrong arguments.
enum ExitCode : int { exit_ok = 0, exit_failed = 1, exit_usage = 2 };

struct Arguments {
    std::vector<std::string> scenes, peers;
    RaceOptions options;
    bool stages = false, json = false;
};

std::vector<std::string> peer_names() {
    std::vector<std::string> names;
    for (const EngineKind& kind : engine_kinds())
        if (kind.name != "embody") names.emplace_back(kind.name);
    return names;
}

std::string joined(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : ", ") + word;
    return line;
}

void add_options(CLI::App& app, Arguments& into) {
    const auto names = race_scene_names();
    const std::vector<std::string> scenes(names.begin(), names.end());
    app.set_help_flag("-h,--help", "Print this help");
    app.add_option("--scene", into.scenes, "Only this scene, repeatable: " + joined(scenes))
        ->type_name("NAME")
        ->check(CLI::IsMember(scenes).description(""));
    app.add_option("--peer", into.peers, "Only against this engine, repeatable; found here: " + joined(peer_names()))
        ->type_name("NAME")
        ->check(CLI::IsMember(peer_names()).description(""));
    app.add_option("--threads", into.options.setup.threads, "Threads to step with; more than 1 is timed by wall clock")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    app.add_flag("--sleep", into.options.setup.sleep, "Let bodies at rest fall asleep (default: never)");
    app.add_option("--repeats", into.options.repeats, "Runs of which each frame's least time counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_option("--steps", into.options.steps, "Steps of each scene (default: its own number)")
        ->check(CLI::Range(1, 1'000'000));
    app.add_flag("--stages", into.stages, "Where Embody's time went, stage by stage");
    app.add_flag("--json", into.json, "Print JSON for programs");
    app.footer(
        "Times are milliseconds a step; embody/ is Embody's mean over the engine's, p99 the same of the 99th "
        "percentiles: below 1 Embody is faster.\nA row is marked WRONG where the end state is not as it must be. "
        "Exit code 1: Embody's own is wrong.\n"
        "Example:\n  embody bench race --scene tall_stack --peer bullet --stages");
}

std::vector<EngineKind> chosen_engines(const std::vector<std::string>& peers) {
    std::vector<EngineKind> chosen;
    for (const EngineKind& kind : engine_kinds())
        if (kind.name == "embody" || peers.empty() || std::find(peers.begin(), peers.end(), kind.name) != peers.end())
            chosen.push_back(kind);
    return chosen;
}

int run(const Arguments& arguments) {
    nlohmann::json results = nlohmann::json::array();
    bool all_right = true;
    for (const std::string_view name : race_scene_names()) {
        const auto& wanted = arguments.scenes;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
        const auto scene = make_race_scene(name);
        const auto result = race(*scene, chosen_engines(arguments.peers), arguments.options);
        if (!result) {
            fmt::print(stderr, "embody: {}\n", result.error().message());
            return exit_failed;
        }
        all_right = all_right && embody_is_right(*result);
        if (arguments.json)
            results.push_back(to_json(*result));
        else
            print_race(*result, arguments.options, arguments.stages);
    }
    if (arguments.json) {
        const nlohmann::json answer = {{"suite", "race"},
                                       {"clock", arguments.options.setup.threads == 1 ? "cpu" : "wall"},
                                       {"sleep", arguments.options.setup.sleep},
                                       {"repeats", arguments.options.repeats},
                                       {"scenes", std::move(results)}};
        fmt::print("{}\n", answer.dump(2));
    }
    return all_right ? exit_ok : exit_failed;
}

}  // namespace
}  // namespace embody::race

int main(int count, char** words) {
    CLI::App app("Race Embody against other engines, side by side in one process.", "embody bench race");
    embody::race::Arguments arguments;
    embody::race::add_options(app, arguments);
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? embody::race::exit_ok : embody::race::exit_usage;
    }
    const int code = embody::race::run(arguments);
    if (std::fflush(stdout) == 0) return code;
    std::perror("embody: standard output");
    return embody::race::exit_failed;
}
