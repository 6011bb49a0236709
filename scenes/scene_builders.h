// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/document/document.h"
#include "scene/simulation/simulation.h"

namespace embody::scenes {

/// What the paper's Table I says of a scene, ms a step on its machine of 2009; all 0 where it says nothing.
struct PaperTimes {
    double max_ms = 0, min_ms = 0, average_ms = 0;
};

/// A scene that tests, benches and demos share: what you watch is what is tested and timed.
struct SceneBuilder {
    std::string name;    ///< e.g. "table1_e"
    std::string title;   ///< for people
    std::string figure;  ///< of the paper; empty where it is ours
    PaperTimes paper;
    int steps = 600;  ///< a bench's length at 60 Hz
    scene::Document (*build)() = nullptr;
    /// What must be true after `steps` steps; empty: it is, else what is wrong. A fast wrong answer fails.
    std::string (*check)(const scene::Simulation& simulation) = nullptr;
};

/// All scenes, the paper's first.
const std::vector<SceneBuilder>& scene_builders();
/// Null where there is none of that name.
const SceneBuilder* find_scene_builder(std::string_view name);

}  // namespace embody::scenes
