// SPDX-License-Identifier: MIT
#include "cli/bench_tanks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "benches/convergence/closed_tanks.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

constexpr double seconds = 60, pause = 0.25, told_every = 10;
constexpr double max_gain = 1e-3;  // above the energy at the start, of that

std::string judge(const convergence::TankRun& run) {
    if (run.lost > 0) return std::to_string(run.lost) + " particles are lost";
    if (!std::isfinite(run.moments.back().energy)) return "not finite";
    return run.highest > (1 + max_gain) * run.moments[0].energy ? "energy has come from nothing" : "";
}

}  // namespace

int run_tanks(const BenchArguments& arguments) {
    const auto tanks = convergence::closed_tanks();
    if (!arguments.scene.empty() &&
        std::ranges::none_of(tanks, [&](const auto& tank) { return tank.name == arguments.scene; }))
        return report({"--scene " + arguments.scene, "there is no such scene", "embody bench tanks runs all"});
    if (!arguments.json) {
        print_text("Closed tanks of 0.4 m for {:.0f} s at 60 Hz, nothing asleep; the momenta of what is free.\n",
                   seconds);
        print_text("{} {:>5} {:>10} {:>12} {:>12}\n", padded("tank", 6), "s", "J", "change Ns", "spin Nms");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool all_right = true;
    for (const convergence::ClosedTank& tank : tanks) {
        if (!arguments.scene.empty() && tank.name != arguments.scene) continue;
        const auto run = tank.run(seconds, pause);
        if (!run) return report(run.error());
        const std::string wrong = judge(*run);
        all_right = all_right && wrong.empty();
        nlohmann::json moments = nlohmann::json::array();
        for (const convergence::TankMoment& moment : run->moments) {
            moments.push_back({moment.time, moment.energy, moment.momentum, moment.spin});
            const bool is_told = std::fabs(std::remainder(moment.time, told_every)) < pause / 2;
            if (!arguments.json && is_told)
                print_text("{} {:>5.0f} {:>10.4g} {:>12.3g} {:>12.6g}\n", padded(std::string(tank.name), 6),
                           moment.time, moment.energy, moment.momentum, moment.spin);
        }
        if (!arguments.json) {
            print_text("{} {} particles, largest rise above an earlier energy {:.2g} J; {}\n",
                       padded(std::string(tank.name), 6), run->particles, run->highest_gain,
                       wrong.empty() ? "right" : "WRONG: " + wrong);
            std::fflush(stdout);
        }
        rows.push_back({{"tank", tank.name},
                        {"what", tank.what},
                        {"particles", run->particles},
                        {"lost", run->lost},
                        {"highest", run->highest},
                        {"highest_gain", run->highest_gain},
                        {"moments", std::move(moments)},
                        {"end_state", wrong.empty() ? "right" : wrong}});
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"tanks", std::move(rows)}});
    return all_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
