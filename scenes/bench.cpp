// SPDX-License-Identifier: MIT
#include "scenes/bench.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace embody::scenes {

Result<BenchResult> run_bench(const SceneBuilder& builder, int steps) {
    auto simulation = scene::Simulation::create(builder.build(), nullptr);
    if (!simulation) return simulation.error();
    BenchResult result;
    result.steps = steps > 0 ? steps : builder.steps;
    result.min_ms = std::numeric_limits<double>::max();
    for (const scene::EntityIndex entity : (*simulation)->entities())
        result.bodies += std::isfinite((*simulation)->world().mass((*simulation)->body(entity)));
    for (int i = 0; i < result.steps; ++i) {
        const double ms = (*simulation)->step().milliseconds;
        result.max_ms = std::max(result.max_ms, ms);
        result.min_ms = std::min(result.min_ms, ms);
        result.average_ms += ms / result.steps;
    }
    // Other lengths end in other states.
    result.checked = result.steps == builder.steps;
    if (result.checked) result.wrong = builder.check(**simulation);
    return result;
}

}  // namespace embody::scenes
