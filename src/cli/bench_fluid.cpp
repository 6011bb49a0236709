// SPDX-License-Identifier: MIT
#include "cli/bench_fluid.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/output.h"
#include "scenes/structures/fluid_tank.h"

namespace embody::cli {
namespace {

constexpr int particles[] = {15'000, 30'000, 60'000};
constexpr int worker_counts[] = {1, 2, 0};  // 0: as many as pay
constexpr int runs = 3;

}  // namespace

int run_fluid(const BenchArguments& arguments) {
    nlohmann::json rows = nlohmann::json::array();
    bool right = true;
    if (!arguments.json) {
        print_text(
            "Sloshing water, 20 floating boxes, 180 beside it; 3 s at 60 Hz, of each step the fastest of {} runs. "
            "Workers 0: as many as pay.\n",
            runs);
        print_text("particles  workers  fluid ms  step ms  worst ms  volume %  draft %  end state\n");
    }
    for (const int count : particles) {
        std::vector<scenes::TankCost> costs;
        for (int run = 0; run < runs; ++run) {
            for (std::size_t i = 0; i < std::size(worker_counts); ++i) {
                auto cost = scenes::time_tank({.particles = count, .workers = worker_counts[i]});
                if (!cost) return report(cost.error());
                if (run == 0) {
                    costs.push_back(std::move(*cost));
                } else {
                    costs[i].take_faster(*cost);
                }
            }
        }
        for (std::size_t i = 0; i < costs.size(); ++i) {
            const scenes::TankCost& cost = costs[i];
            const double fluid = scenes::TankCost::mean(cost.fluid_ms), step = scenes::TankCost::mean(cost.step_ms),
                         worst = *std::max_element(cost.step_ms.begin(), cost.step_ms.end());
            right = right && cost.wrong.empty();
            rows.push_back({{"particles", cost.particles},
                            {"workers", worker_counts[i]},
                            {"fluid_ms", fluid},
                            {"step_ms", step},
                            {"worst_step_ms", worst},
                            {"volume_error", cost.volume_error},
                            {"draft_error", cost.draft_error},
                            {"wrong", cost.wrong}});
            if (arguments.json) continue;
            print_text("{:>9} {:>8} {:>9.2f} {:>8.2f} {:>9.2f} {:>9.2f} {:>8.1f}  {}\n", cost.particles,
                       worker_counts[i], fluid, step, worst, 100 * cost.volume_error, 100 * cost.draft_error,
                       cost.wrong.empty() ? "right" : "WRONG: " + cost.wrong);
            std::fflush(stdout);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"tanks", rows}});
    return right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
