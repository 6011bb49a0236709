// SPDX-License-Identifier: MIT
#include "cli/bench_soft.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "scenes/structures/cushions.h"

namespace embody::cli {

int run_soft(const BenchArguments& arguments) {
    if (!arguments.json) {
        print_text(
            "Milliseconds per step at 60 Hz, nothing asleep, beside 200 boxes in stacks. Workers 0: as many as pay.\n");
        print_text("nodes   tetrahedra  workers  falling  at rest    worst  deformables  foam   end state\n");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool is_right = true;
    for (const int cells : {6, 10, 15}) {
        std::uint64_t hash = 0;
        for (const int workers : {1, 2, 0}) {  // 0: as many as pay
            auto cost = scenes::time_cushions({.cells = cells, .workers = workers});
            if (!cost) return report(cost.error());
            if (workers != 1 && cost->hash != hash) cost->wrong = "other bits than with one worker";
            hash = cost->hash;
            is_right = is_right && cost->wrong.empty();
            rows.push_back({{"nodes", cost->nodes},
                            {"tetrahedra", cost->tetrahedra},
                            {"workers", workers},
                            {"falling_ms", cost->fall_ms},
                            {"at_rest_ms", cost->rest_ms},
                            {"worst_ms", cost->worst_ms},
                            {"deformables_ms", cost->solids_ms},
                            {"foam_compression", cost->compression},
                            {"end_state", cost->wrong.empty() ? "right" : cost->wrong}});
            if (arguments.json) continue;
            print_text("{:>5} {:>12} {:>8} {:>8.2f} {:>8.2f} {:>8.2f} {:>12.2f} {:>5.3f}   {}\n", cost->nodes,
                       cost->tetrahedra, workers, cost->fall_ms, cost->rest_ms, cost->worst_ms, cost->solids_ms,
                       cost->compression, cost->wrong.empty() ? "right" : "WRONG: " + cost->wrong);
            std::fflush(stdout);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"rows", rows}});
    return is_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
