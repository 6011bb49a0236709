// SPDX-License-Identifier: MIT
#include "cli/bench_simbenchmark.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "benches/simbenchmark/simbenchmark.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

using simbenchmark::Accuracy;
using simbenchmark::AccuracyTest;
using simbenchmark::Published;

std::string_view verdict(const Accuracy& accuracy, const Published* best) {
    if (!std::isfinite(accuracy.error)) return "WRONG";
    if (best == nullptr) return "none published";
    return accuracy.error <= best->error ? "better" : "worse";
}

nlohmann::json to_json(const AccuracyTest& test, double time_step, const Accuracy& accuracy) {
    const Published* best = test.published(time_step);
    nlohmann::json row = {{"scene", test.name},
                          {"what", test.what},
                          {"measured", test.error},
                          {"unit", test.unit},
                          {"time_step", time_step},
                          {"steps", accuracy.steps},
                          {"step_ms", accuracy.step_milliseconds},
                          {"error", accuracy.error},
                          {"verdict", verdict(accuracy, best)}};
    if (best != nullptr) {
        row["published"] = {{"error", best->error}, {"engine", best->engine}};
        row["over_published"] = accuracy.error / best->error;
    }
    return row;
}

void print_row(const AccuracyTest& test, double time_step, const Accuracy& accuracy) {
    const Published* best = test.published(time_step);
    const std::string published = best == nullptr ? "–" : fmt::format("{:.3g} {}", best->error, best->engine);
    const std::string ratio = best == nullptr ? "–" : fmt::format("{:.3g}", accuracy.error / best->error);
    print_text("{} {:>5.0f} {:>12.4g} {} {} {} {:>9.4f}   {}\n", padded(test.name, 12), time_step * 1e3, accuracy.error,
               padded(std::string(test.unit), 6), padded(published, 16), padded(ratio, 9), accuracy.step_milliseconds,
               verdict(accuracy, best));
    std::fflush(stdout);
}

void print_head() {
    print_text(
        "Errors of SimBenchmark's tests beside the smallest published one of five engines; below 1 is better.\n");
    print_text("{} {:>5} {:>12} {} {} {} {:>9}   {}\n", padded("test", 12), "dt ms", "error", padded("", 6),
               padded("best published", 16), padded("ratio", 9), "ms a step", "verdict");
}

}  // namespace

int run_simbenchmark(const BenchArguments& arguments) {
    if (!arguments.scene.empty() && simbenchmark::find_accuracy_test(arguments.scene) == nullptr)
        return report({"--scene " + arguments.scene, "there is no such test", "embody bench simbenchmark runs all"});
    if (!arguments.json) print_head();
    nlohmann::json rows = nlohmann::json::array();
    bool all_finite = true;
    for (const AccuracyTest& test : simbenchmark::accuracy_tests()) {
        if (!arguments.scene.empty() && test.name != arguments.scene) continue;
        for (const double time_step : simbenchmark::accuracy_time_steps) {
            const auto accuracy = simbenchmark::run_accuracy_test(test, time_step);
            if (!accuracy) return report(accuracy.error());
            all_finite = all_finite && std::isfinite(accuracy->error);
            rows.push_back(to_json(test, time_step, *accuracy));
            if (!arguments.json) print_row(test, time_step, *accuracy);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"scenes", std::move(rows)}});
    return all_finite ? exit_ok : exit_failed;
}

}  // namespace embody::cli
