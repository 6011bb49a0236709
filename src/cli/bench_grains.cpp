// SPDX-License-Identifier: MIT
#include "cli/bench_grains.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "scenes/structures/grain_heap.h"

namespace embody::cli {
namespace {

constexpr double tolerance = 2;  // degrees

struct Size {
    double diameter;
    int grains;
};
constexpr double angles[] = {21, 27, 32, 34, 38, 44};
constexpr Size sizes[] = {{0.005, 1500}, {0.01, 1500}, {0.01, 3000}, {0.03, 1500}};
constexpr int slabs[] = {1000, 2000, 5000};

/// Rows of the report, and whether all heaps were within the tolerance.
struct Rows {
    nlohmann::json heaps = nlohmann::json::array(), slabs = nlohmann::json::array();
    bool right = true;
};

Result<void> measure_heaps(bool print, Rows& rows) {
    if (print) print_text("asked deg  grains  mm    poured  drawn wall  overlap  rest s\n");
    for (const double angle : angles) {
        for (const Size& size : sizes) {
            const scenes::HeapToPour definition{
                .friction_angle = angle, .diameter = size.diameter, .grains = size.grains, .workers = 0};
            const auto heap = scenes::pour_heap(definition);
            if (!heap) return heap.error();
            const auto wall = scenes::draw_wall_away(definition);
            if (!wall) return wall.error();
            rows.right = rows.right && heap->asleep && std::fabs(heap->angle - angle) <= tolerance;
            rows.heaps.push_back({{"friction_angle_deg", angle},
                                  {"grains", size.grains},
                                  {"diameter_m", size.diameter},
                                  {"poured_deg", heap->angle},
                                  {"drawn_wall_deg", *wall},
                                  {"overlap_diameters", heap->overlap},
                                  {"rest_s", heap->rest_seconds}});
            if (!print) continue;
            print_text("{:>9} {:>7} {:>3} {:>9.1f} {:>11.1f} {:>8.3f} {:>7.1f}\n", angle, size.grains,
                       1000 * size.diameter, heap->angle, *wall, heap->overlap, heap->rest_seconds);
            std::fflush(stdout);
        }
    }
    return {};
}

Result<void> time_slabs(bool print, Rows& rows) {
    if (print) print_text("\ngrains  workers  contacts  awake ms  asleep ms\n");
    for (const int grains : slabs) {
        for (const int workers : {1, 2}) {
            const auto cost = scenes::time_slab({.grains = grains, .workers = workers});
            if (!cost) return cost.error();
            rows.slabs.push_back({{"grains", grains},
                                  {"workers", workers},
                                  {"contacts", cost->contacts},
                                  {"awake_ms", cost->awake_ms},
                                  {"asleep_ms", cost->asleep_ms}});
            if (print)
                print_text("{:>6} {:>8} {:>9} {:>9.2f} {:>10.5f}\n", grains, workers, cost->contacts, cost->awake_ms,
                           cost->asleep_ms);
        }
    }
    return {};
}

}  // namespace

int run_grains(const BenchArguments& arguments) {
    Rows rows;
    if (const auto measured = measure_heaps(!arguments.json, rows); !measured) return report(measured.error());
    if (const auto timed = time_slabs(!arguments.json, rows); !timed) return report(timed.error());
    if (arguments.json) print_json({{"suite", arguments.suite}, {"heaps", rows.heaps}, {"slabs", rows.slabs}});
    return rows.right ? exit_ok : exit_failed;
}

}  // namespace embody::cli
