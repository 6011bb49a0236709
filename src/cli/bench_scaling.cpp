// SPDX-License-Identifier: MIT
#include "cli/bench_scaling.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "benches/scaling/scaling.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using scaling::Cost;

double nanoseconds_a_body(const Cost& cost) { return cost.step_milliseconds * 1e6 / cost.bodies; }

nlohmann::json to_json(scaling::Scene scene, const Cost& cost, std::optional<double> growth) {
    return {{"scene", scaling::name_of(scene)},
            {"what", scaling::what_of(scene)},
            {"bodies", cost.bodies},
            {"contacts", cost.contacts},
            {"step_ms", cost.step_milliseconds},
            {"body_step_ns", nanoseconds_a_body(cost)},
            {"memory_kb_a_body", cost.memory_kilobytes},
            {"growth_exponent", growth ? nlohmann::json(*growth) : nlohmann::json()},
            {"end_state", cost.wrong.empty() ? "right" : cost.wrong}};
}

void print_row(scaling::Scene scene, const Cost& cost, std::optional<double> growth) {
    print_text("{} {:>7} {:>8} {:>12.5f} {:>10.2f} {:>10.2f} {:>7}   {}\n",
               padded(std::string(scaling::name_of(scene)), 14), cost.bodies, cost.contacts, cost.step_milliseconds,
               nanoseconds_a_body(cost), cost.memory_kilobytes, growth ? fmt::format("{:.2f}", *growth) : "",
               cost.wrong.empty() ? "right" : "WRONG: " + cost.wrong);
    std::fflush(stdout);
}

bool is_scene(std::string_view name) {
    return std::any_of(std::begin(scaling::scenes), std::end(scaling::scenes),
                       [&](scaling::Scene scene) { return scaling::name_of(scene) == name; });
}

}  // namespace

int run_scaling(const BenchArguments& arguments) {
    if (!arguments.scene.empty() && !is_scene(arguments.scene))
        return report({"--scene " + arguments.scene, "there is no such scene", "embody bench scaling runs all"});
    if (!arguments.json) {
        print_text("CPU time of one thread; growth is the exponent from the row above, 1 is linear.\n");
        print_text("{} {:>7} {:>8} {:>12} {:>10} {:>10} {:>7}   {}\n", padded("scene", 14), "bodies", "contacts",
                   "ms a step", "ns a body", "KB a body", "growth", "end state");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const scaling::Scene scene : scaling::scenes) {
        if (!arguments.scene.empty() && arguments.scene != scaling::name_of(scene)) continue;
        std::optional<Cost> smaller;
        for (const int bodies : scaling::sizes) {
            if (bodies > arguments.bodies) break;
            const auto cost = scaling::measure(scene, bodies);
            if (!cost) return report(cost.error());
            all_right = all_right && cost->wrong.empty();
            const auto growth = smaller ? std::optional(scaling::growth(*smaller, *cost)) : std::nullopt;
            rows.push_back(to_json(scene, *cost, growth));
            if (!arguments.json) print_row(scene, *cost, growth);
            smaller = *cost;
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"scenes", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
