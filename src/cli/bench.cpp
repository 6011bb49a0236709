// SPDX-License-Identifier: MIT
#include "scenes/bench.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/bench_catalogue.h"
#include "cli/bench_cloth.h"
#include "cli/bench_convergence.h"
#include "cli/bench_decomposition.h"
#include "cli/bench_fluid.h"
#include "cli/bench_grains.h"
#include "cli/bench_matter.h"
#include "cli/bench_race.h"
#include "cli/bench_scaling.h"
#include "cli/bench_simbenchmark.h"
#include "cli/bench_soft.h"
#include "cli/bench_stability.h"
#include "cli/bench_tanks.h"
#include "cli/bench_tetrahedra.h"
#include "cli/commands.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

nlohmann::json to_json(const scenes::SceneBuilder& builder, const scenes::BenchResult& result) {
    return {{"scene", builder.name},
            {"title", builder.title},
            {"figure", builder.figure},
            {"bodies", result.bodies},
            {"steps", result.steps},
            {"max_ms", result.max_ms},
            {"min_ms", result.min_ms},
            {"average_ms", result.average_ms},
            {"paper",
             {{"max_ms", builder.paper.max_ms},
              {"min_ms", builder.paper.min_ms},
              {"average_ms", builder.paper.average_ms}}},
            {"end_state", result.checked ? (result.wrong.empty() ? "right" : result.wrong) : "not checked"}};
}

std::string paper_number(double ms) { return ms > 0 ? fmt::format("{:.3f}", ms) : "–"; }

void print_row(const scenes::SceneBuilder& builder, const scenes::BenchResult& result) {
    const std::string end = !result.checked ? "not checked" : result.wrong.empty() ? "right" : "WRONG: " + result.wrong;
    print_text("{} {:>6} {:>9.3f} {:>9.3f} {:>9.3f}   {:>7} {:>7} {:>7}   {}\n", padded(builder.name, 15),
               result.bodies, result.max_ms, result.min_ms, result.average_ms, paper_number(builder.paper.max_ms),
               paper_number(builder.paper.min_ms), paper_number(builder.paper.average_ms), end);
}

}  // namespace

int run_bench(const BenchArguments& arguments) {
    if (arguments.suite == "race") return run_race(arguments.race_words);
    if (arguments.suite == "stability") return run_stability(arguments);
    if (arguments.suite == "simbenchmark") return run_simbenchmark(arguments);
    if (arguments.suite == "scaling") return run_scaling(arguments);
    if (arguments.suite == "decomposition") return run_decomposition(arguments);
    if (arguments.suite == "cloth") return run_cloth(arguments);
    if (arguments.suite == "convergence") return run_convergence(arguments);
    if (arguments.suite == "fluid") return run_fluid(arguments);
    if (arguments.suite == "soft") return run_soft(arguments);
    if (arguments.suite == "grains") return run_grains(arguments);
    if (arguments.suite == "matter") return run_matter(arguments);
    if (arguments.suite == "tanks") return run_tanks(arguments);
    if (arguments.suite == "tetrahedra") return run_tetrahedra(arguments);
    if (arguments.suite == "catalogue") return run_catalogue_bench(arguments);
    if (!arguments.scene.empty() && scenes::find_scene_builder(arguments.scene) == nullptr)
        return report({"--scene " + arguments.scene, "there is no such scene", "embody scene lists them"});
    if (!arguments.json) {
        print_text("Milliseconds per step at 60 Hz; the paper's on a Core 2 Quad Q9400 of 2009.\n");
        print_text("{} {:>6} {:>9} {:>9} {:>9}   {:>7} {:>7} {:>7}   {}\n", padded("scene", 15), "bodies", "max", "min",
                   "average", "paper:", "min", "average", "end state");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const scenes::SceneBuilder& builder : scenes::scene_builders()) {
        if (!arguments.scene.empty() && builder.name != arguments.scene) continue;
        const auto result = scenes::run_bench(builder, arguments.steps);
        if (!result) return report(result.error());
        all_right = all_right && result->wrong.empty();
        rows.push_back(to_json(builder, *result));
        if (!arguments.json) print_row(builder, *result);
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"scenes", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
