// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "physics/inter/world.h"

namespace embody::physics {

/// A world with valid settings. EMBODY_SETTING changes one number of its solvers: tools/try_settings.py uses it to find
/// out which tests detect the change.
inline std::unique_ptr<World> make_world(WorldSettings settings = {}) {
    if (const char* wish = std::getenv("EMBODY_SETTING")) {
        const std::string text = wish;
        const std::size_t end = text.find('=');
        EXPECT_TRUE(set_setting(settings.solver, text.substr(0, end), std::stod(text.substr(end + 1)))) << text;
    }
    return std::move(World::create(settings)).value();
}

}  // namespace embody::physics
