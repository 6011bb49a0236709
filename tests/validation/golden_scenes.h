// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <ostream>
#include <span>

#include "physics/inter/world.h"

namespace embody::physics {

/// A world and what is done to it before some steps.
struct GoldenScene {
    std::unique_ptr<World> world;
    void (*before_step)(World& world, int step) = nullptr;
};

struct Golden {
    const char* name;
    GoldenScene (*build)();

    friend std::ostream& operator<<(std::ostream& out, const Golden& golden) { return out << golden.name; }
};

/// Ten scenes of rigid bodies, of each kind of shape and joint. What builds them uses no library functions but square
/// roots, so that they are the same bits in every build.
std::span<const Golden> golden_scenes();

}  // namespace embody::physics
