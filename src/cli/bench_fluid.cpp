// SPDX-License-Identifier: MIT
#include "cli/bench_fluid.h"

#include <fmt/core.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "scenes/structures/fluid_tank.h"

namespace embody::cli {
namespace {

constexpr int particles[] = {15'000, 30'000, 60'000};

}  // namespace

int run_fluid(const BenchArguments& arguments) {
    nlohmann::json rows = nlohmann::json::array();
    bool right = true;
    if (!arguments.json) {
        fmt::print("Water that sloshes, 20 boxes afloat, 180 beside it; mean of 3 s at 60 Hz.\n");
        fmt::print("particles  workers  fluid ms  step ms  worst ms  volume %  draft %  end state\n");
    }
    for (const int count : particles) {
        for (const int workers : {1, 2}) {
            const auto cost = scenes::time_tank({.particles = count, .workers = workers});
            if (!cost) return report(cost.error());
            right = right && cost->wrong.empty();
            rows.push_back({{"particles", cost->particles},
                            {"workers", workers},
                            {"fluid_ms", cost->fluid_ms},
                            {"step_ms", cost->step_ms},
                            {"worst_step_ms", cost->worst_step_ms},
                            {"volume_error", cost->volume_error},
                            {"draft_error", cost->draft_error},
                            {"wrong", cost->wrong}});
            if (arguments.json) continue;
            fmt::print("{:>9} {:>8} {:>9.2f} {:>8.2f} {:>9.2f} {:>9.2f} {:>8.1f}  {}\n", cost->particles, workers,
                       cost->fluid_ms, cost->step_ms, cost->worst_step_ms, 100 * cost->volume_error,
                       100 * cost->draft_error, cost->wrong.empty() ? "right" : "WRONG: " + cost->wrong);
            std::fflush(stdout);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"tanks", rows}});
    return right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
