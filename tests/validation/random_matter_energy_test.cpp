// SPDX-License-Identifier: MIT
// Energy of random scenes of all kinds of matter never rises above what they began with (docs/physics/energy.md, "All
// kinds of matter"). Each run does a few scenes;
//     EMBODY_MATTER_SCENES=500 EMBODY_MATTER_TELL=1 test_validation --gtest_filter=RandomMatter.*
// does so many (ctest --preset laws: 250) and tells what each gained.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "validation/random_bodies.h"
#include "validation/random_matter.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double allowed_gain_of_matter = 1e-3;  // of kinetic energy at the start and potential energy above the ground

/// Highest energy of five seconds above that at the start.
struct HighestEnergy {
    double gain = 0;  ///< share of the energy at the start
    double time = 0;  ///< when, s
};

HighestEnergy highest_energy(World& world) {
    const double start = energy(world);
    HighestEnergy highest;
    for (int i = 1; i <= 300; ++i) {
        world.step();
        const double gain = energy(world) / start - 1;
        if (gain <= highest.gain) continue;
        // Also what is not a number.
        highest = {gain, i * world.settings().time_step};
        if (!std::isfinite(gain)) break;
    }
    return highest;
}

bool is_of_bodies(MatterKind kind) {
    return kind == MatterKind::rigid || kind == MatterKind::jointed || kind == MatterKind::grains;
}

TEST(RandomMatter, NeverRisesAboveTheEnergyItBeganWith) {
    // Some scenes with deformables and liquids do: docs/physics/energy.md says how many and why. None of bodies alone
    // does, and none of the scenes of each run.
    constexpr double allowed_share = 0.08;
    constexpr int scenes_of_each_run = 24;
    const int scenes = wanted_cases("EMBODY_MATTER_SCENES", scenes_of_each_run);
    ASSERT_GT(scenes, 0);
    int above = 0;
    double largest = 0;
    for (int seed = 1; seed <= scenes; ++seed) {
        const MatterScene scene = random_matter(static_cast<std::uint64_t>(seed));
        const HighestEnergy highest = highest_energy(*scene.world);
        if (std::getenv("EMBODY_MATTER_TELL") != nullptr) {
            std::printf("matter %d %s: gain %.2g at %.3f s\n", seed, scene.kinds_together().c_str(), highest.gain,
                        highest.time);
        }
        const bool is_above = !(highest.gain <= allowed_gain_of_matter);
        above += is_above ? 1 : 0;
        largest = std::max(largest, highest.gain);
        if (seed <= scenes_of_each_run || std::ranges::all_of(scene.kinds, is_of_bodies)) {
            EXPECT_FALSE(is_above) << "seed " << seed << " " << scene.kinds_together() << ": " << highest.gain;
        }
    }
    RecordProperty("scenes above the bar", above);
    RecordProperty("largest gain, of the first energy", std::to_string(largest));
    EXPECT_LE(above, allowed_share * scenes);
}

// Turns of more than half a turn a step counted whole in the sheet's friction: 125 J became 623 J.
TEST(RandomMatter, GrainsBetweenASheetAndASolidAreNotSpunUp) {
    const MatterScene scene = random_matter(36, 0b1101);
    double least = energy(*scene.world);
    for (int i = 0; i < 60; ++i) {
        scene.world->step();
        least = std::min(least, energy(*scene.world));
        // It still rises by half of the least.
        EXPECT_LT(energy(*scene.world), 2 * least) << i;
    }
}

// Of balls that turned by more than half a turn a step the solid saw the turn the other way and drove it on.
TEST(RandomMatter, GrainsUnderASolidAreNotSpunUp) {
    const MatterScene scene = random_matter(30, 0b101);
    const double first = energy(*scene.world);
    for (int i = 0; i < 300; ++i) {
        scene.world->step();
        ASSERT_LT(energy(*scene.world), (1 + allowed_gain_of_matter) * first) << "at step " << i;
    }
}

// The drag of grains gave drops and the rim of a film what only a full cell of a viscous liquid can pass on, and liquid
// was made up between grains in the air: 50 and 10^18 times the energy.
TEST(RandomMatter, GrainsGainNothingFromThinLiquid) {
    for (const auto& [seed, kept] : {std::pair{213, 0b101u}, std::pair{231, 0b110u}}) {
        const MatterScene scene = random_matter(static_cast<std::uint64_t>(seed), kept);
        const double first = energy(*scene.world);
        for (int i = 0; i < 100; ++i) {
            scene.world->step();
            ASSERT_LT(energy(*scene.world), (1 + allowed_gain_of_matter) * first) << seed << " at step " << i;
        }
    }
}

// A heap of grains smaller than the liquid's cells in the corner of a tub: where their spread volumes shut the faces of
// a cell, liquid was shut in with them, and its pressure shot them off at 4,200 m/s.
TEST(RandomMatter, GrainsThatLieCloseAreNoWallsForLiquid) {
    const MatterScene scene = random_matter(105);
    EXPECT_LT(highest_energy(*scene.world).gain, allowed_gain_of_matter);
}

}  // namespace
}  // namespace embody::physics
