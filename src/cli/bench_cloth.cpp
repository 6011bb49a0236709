// SPDX-License-Identifier: MIT
#include "cli/bench_cloth.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "scenes/structures/tablecloth.h"

namespace embody::cli {

int run_cloth(const BenchArguments& arguments) {
    if (!arguments.json) {
        print_text(
            "Milliseconds per step at 60 Hz, nothing asleep, beside 200 boxes in stacks. Workers 0: as many as pay.\n");
        print_text("nodes   edges  workers  falling  at rest    worst  deformables   end state\n");
    }
    nlohmann::json rows = nlohmann::json::array();
    bool is_right = true;
    for (const int edges : {3'000, 10'000, 30'000}) {
        std::uint64_t hash = 0;
        for (const int workers : {1, 2, 0}) {  // 0: as many as pay
            auto cost = scenes::time_tablecloth({.edges = edges, .workers = workers});
            if (!cost) return report(cost.error());
            if (workers != 1 && cost->hash != hash) cost->wrong = "other bits than with one worker";
            hash = cost->hash;
            is_right = is_right && cost->wrong.empty();
            rows.push_back({{"nodes", cost->nodes},
                            {"edges", cost->edges},
                            {"workers", workers},
                            {"falling_ms", cost->fall_ms},
                            {"at_rest_ms", cost->rest_ms},
                            {"worst_ms", cost->worst_ms},
                            {"deformables_ms", cost->cloth_ms},
                            {"end_state", cost->wrong.empty() ? "right" : cost->wrong}});
            if (arguments.json) continue;
            print_text("{:>5} {:>7} {:>8} {:>8.2f} {:>8.2f} {:>8.2f} {:>12.2f}   {}\n", cost->nodes, cost->edges,
                       workers, cost->fall_ms, cost->rest_ms, cost->worst_ms, cost->cloth_ms,
                       cost->wrong.empty() ? "right" : "WRONG: " + cost->wrong);
            std::fflush(stdout);
        }
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"rows", rows}});
    return is_right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
