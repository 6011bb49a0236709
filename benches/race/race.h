// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benches/race/end_state.h"

namespace embody::race {

struct RaceOptions {
    EngineSetup setup;
    int repeats = 3;  ///< >= 1
    int steps = 0;    ///< 0: the scene's own number
};

/// One engine's run of one scene. Each frame's time is the minimum over the repeats, in which its work is the same.
struct Lap {
    std::string engine, settings;
    int threads = 1;
    double mean_ms = 0, median_ms = 0, p99_ms = 0, max_ms = 0;  ///< over all frames
    EndState end;                                               ///< of the last repeat
    std::vector<StageTime> stages;                              ///< mean per step, wall time; only Embody's
};

struct RaceResult {
    const RaceScene* scene = nullptr;
    int steps = 0;
    std::vector<Lap> laps;  ///< in the order of the engines
};

/// Runs the scene in all engines in turns: a block of frames of one after the other, so that other work of the machine
/// affects all of them equally. Timed by the process's CPU clock for one thread, by wall clock for more.
Result<RaceResult> race(const RaceScene& scene, const std::vector<EngineKind>& kinds, const RaceOptions& options);

}  // namespace embody::race
