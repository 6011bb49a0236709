// SPDX-License-Identifier: MIT
#include "cli/bench_matter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benches/scaling/matter.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using scaling::MatterCost;

// Over the row with half as much.
std::string growth_of(const MatterCost* smaller, const MatterCost& cost) {
    return smaller ? fmt::format("{:.2f}", scaling::growth(*smaller, cost)) : "";
}

void print_row(scaling::Matter matter, const MatterCost& cost, int workers, const MatterCost* smaller) {
    print_text(
        "{} {:>8} {} {:>7} {:>9.2f} {:>9.2f} {:>10.1f} {:>7}   {}\n", padded(std::string(scaling::name_of(matter)), 7),
        cost.elements, padded(std::string(scaling::element_of(matter)), 10), workers, cost.mean_ms, cost.worst_ms,
        cost.worst_ms / cost.mean_ms, growth_of(smaller, cost), cost.wrong.empty() ? "right" : "WRONG: " + cost.wrong);
    std::fflush(stdout);
}

nlohmann::json to_json(scaling::Matter matter, const MatterCost& cost, int workers, const MatterCost* smaller) {
    return {{"scene", scaling::name_of(matter)},
            {"what", scaling::what_of(matter)},
            {"elements", cost.elements},
            {"element", scaling::element_of(matter)},
            {"workers", workers},
            {"mean_ms", cost.mean_ms},
            {"worst_ms", cost.worst_ms},
            {"growth_exponent", smaller ? nlohmann::json(scaling::growth(*smaller, cost)) : nlohmann::json()},
            {"end_state", cost.wrong.empty() ? "right" : cost.wrong}};
}

bool is_matter(std::string_view name) {
    return std::ranges::any_of(scaling::matters,
                               [&](scaling::Matter matter) { return scaling::name_of(matter) == name; });
}

}  // namespace

int run_matter(const BenchArguments& arguments) {
    if (!arguments.scene.empty() && !is_matter(arguments.scene))
        return report({"--scene " + arguments.scene, "there is no such scene", "embody bench matter runs all"});
    if (!arguments.json) {
        print_text(
            "Wall time of a step at 60 Hz, single runs of 1.5 s in motion, nothing asleep. Workers 0: as many as pay.\n"
            "Growth is the exponent from the row with half as much, 1 is linear.\n");
        print_text("{} {:>8} {} {:>7} {:>9} {:>9} {:>10} {:>7}   {}\n", padded("scene", 7), "", padded("", 10),
                   "workers", "mean ms", "worst ms", "worst/mean", "growth", "end state");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const scaling::Matter matter : scaling::matters) {
        if (!arguments.scene.empty() && arguments.scene != scaling::name_of(matter)) continue;
        std::vector<MatterCost> before;  // of the smaller size: with one worker, with many
        for (const int size : scaling::sizes_of(matter)) {
            std::vector<MatterCost> costs;
            for (const int workers : {1, 0}) {
                auto cost = scaling::measure(matter, size, workers);
                if (!cost) return report(cost.error());
                if (!costs.empty() && cost->hash != costs[0].hash) cost->wrong = "other bits than with one worker";
                all_right = all_right && cost->wrong.empty();
                const MatterCost* smaller = before.empty() ? nullptr : &before[costs.size()];
                rows.push_back(to_json(matter, *cost, workers, smaller));
                if (!arguments.json) print_row(matter, *cost, workers, smaller);
                costs.push_back(std::move(*cost));
            }
            before = std::move(costs);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"rows", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
