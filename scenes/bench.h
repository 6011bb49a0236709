// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"
#include "scenes/scene_builders.h"

namespace embody::scenes {

/// Wall time of the steps of one scene, and whether the answer was right.
struct BenchResult {
    double max_ms = 0, min_ms = 0, average_ms = 0;
    int steps = 0;
    int bodies = 0;     ///< movable ones
    std::string wrong;  ///< empty: the end state is as it must be; only checked after the builder's own number of steps
    bool checked = false;
};

/// Builds and steps the scene; `steps` 0: the builder's own number.
Result<BenchResult> run_bench(const SceneBuilder& builder, int steps);

}  // namespace embody::scenes
