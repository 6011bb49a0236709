// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "validation/golden_scenes.h"

namespace embody::physics {

/// A small scene in which settings of one group of SolverSettings show.
struct SettingScene {
    std::string_view group;
    const char* name;
    GoldenScene (*build)();
    int steps = 120;
};

/// Scenes of what golden_scenes() have not: sleep, matter that bends, liquids.
std::span<const SettingScene> setting_scenes();
/// More of matter that bends and of liquids.
std::span<const SettingScene> matter_setting_scenes();

}  // namespace embody::physics
