// SPDX-License-Identifier: MIT
#include "cli/bench_stability.h"

#include <fmt/core.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output.h"
#include "scenes/structures/structure.h"

namespace embody::cli {
namespace {

using scenes::StructureBuilder;
using scenes::StructureResult;

nlohmann::json to_json(const std::optional<double>& number) {
    return number ? nlohmann::json(*number) : nlohmann::json();
}

nlohmann::json to_json(const StructureBuilder& builder, const StructureResult& result) {
    const scenes::StructureGoal& goal = builder.goal;
    return {{"scene", builder.name},
            {"what", builder.what},
            {"pieces", builder.pieces},
            {"seconds", goal.seconds},
            {"stands", result.stands},
            {"fell_at_s", result.stands ? nlohmann::json() : nlohmann::json(result.fell_at)},
            {"sag_m", result.sag},
            {"drift_m", result.drift},
            {"energy_j", result.energy},
            {"asleep_after_s", to_json(result.asleep_after)},
            {"step_ms", result.step_milliseconds},
            {"goal",
             {{"sag_m", to_json(goal.sag)},
              {"drift_m", to_json(goal.drift)},
              {"energy_j", to_json(goal.energy)},
              {"asleep_after_s", to_json(goal.asleep_after)}}},
            {"misses", result.misses(goal)}};
}

void print_row(const StructureBuilder& builder, const StructureResult& result) {
    const std::string stands = result.stands ? "yes" : fmt::format("{:.1f} s", result.fell_at);
    const std::string asleep = result.asleep_after ? fmt::format("{:.2f}", *result.asleep_after) : "never";
    const std::string_view misses = result.misses(builder.goal);
    print_text("| {} | {:>6} | {:>6.0f} | {:>7} | {:>8.3f} | {:>8.3f} | {:>9.2g} | {:>7} | {:>7.3f} | {:<14} |\n",
               padded(builder.name, 17), builder.pieces, builder.goal.seconds, stands, 1e3 * result.sag,
               1e3 * result.drift, result.energy, result.stands ? asleep : "", result.step_milliseconds,
               misses.empty() ? "" : misses);
    std::fflush(stdout);
}

void print_stability_head() {
    print_text(
        "Without sleeping: the time it must stand, how far the pieces sank and went sideways, kinetic energy in\n"
        "the last second; with sleeping: when all slept. The last column says which goal is missed.\n\n");
    print_text("| {} | {:>6} | {:>6} | {:>7} | {:>8} | {:>8} | {:>9} | {:>7} | {:>7} | {:<14} |\n",
               padded("structure", 17), "pieces", "s", "stands", "sag mm", "drift mm", "energy J", "asleep", "ms/step",
               "misses");
    print_text("|---|---|---|---|---|---|---|---|---|---|\n");
}

}  // namespace

int run_stability(const BenchArguments& arguments) {
    if (!arguments.scene.empty() && scenes::find_structure_builder(arguments.scene) == nullptr) {
        return report({"--scene " + arguments.scene, "there is no such structure", "embody bench stability runs all"});
    }
    if (!arguments.json) print_stability_head();
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const StructureBuilder& builder : scenes::structure_builders()) {
        if (!arguments.scene.empty() && builder.name != arguments.scene) continue;
        const StructureResult result = scenes::run_structure(builder);
        all_right = all_right && result.misses(builder.goal).empty();
        rows.push_back(to_json(builder, result));
        if (!arguments.json) print_row(builder, result);
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"scenes", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
