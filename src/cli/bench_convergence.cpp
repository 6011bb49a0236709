// SPDX-License-Identifier: MIT
#include "cli/bench_convergence.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "benches/convergence/convergence.h"
#include "cli/output.h"

namespace embody::cli {

int run_convergence(const BenchArguments& arguments) {
    using namespace convergence;
    if (!arguments.scene.empty() && find_study(arguments.scene) == nullptr) {
        std::string names;
        for (const Study& study : studies()) names += (names.empty() ? "" : ", ") + std::string(study.name);
        return report({"--scene " + arguments.scene, "there is no such study", "one of " + names});
    }
    nlohmann::json all = nlohmann::json::array();
    bool is_finite = true;
    for (const Study& study : studies()) {
        if (!arguments.scene.empty() && study.name != arguments.scene) continue;
        if (!arguments.json) {
            print_text("{}: {}; {} = {:.6g}\n", study.name, study.quantity, study.theory, study.expected);
            print_text("{:>22} {:>12} {:>9}\n", study.resolution, "measured", "error %");
        }
        nlohmann::json rows = nlohmann::json::array();
        for (const int resolution : study.resolutions) {
            const auto value = study.measure(resolution);
            if (!value) return report(value.error());
            const double error = *value / study.expected - 1;
            is_finite = is_finite && std::isfinite(error);
            rows.push_back({{"resolution", resolution}, {"value", *value}, {"error", error}});
            if (arguments.json) continue;
            print_text("{:>22} {:>12.6g} {:>9.3f}\n", resolution, *value, 100 * error);
            std::fflush(stdout);
        }
        all.push_back({{"study", study.name},
                       {"quantity", study.quantity},
                       {"resolution", study.resolution},
                       {"theory", study.theory},
                       {"expected", study.expected},
                       {"rows", std::move(rows)}});
    }
    if (arguments.json) print_json({{"suite", arguments.suite}, {"studies", std::move(all)}});
    return is_finite ? exit_ok : exit_failed;
}

}  // namespace embody::cli
