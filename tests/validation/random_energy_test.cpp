// SPDX-License-Identifier: MIT
// Energy of random scenes without motors never rises above what they began with. Each run does a few scenes;
//     EMBODY_ENERGY_SCENES=1000 test_validation --gtest_filter=RandomScenes.*
// does so many (ctest --preset laws).
#include <gtest/gtest.h>

#include "validation/random_scenes.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

TEST(RandomScenes, NeverRiseAboveTheEnergyTheyBeganWith) {
    constexpr double allowed_gain = 1e-6;
    const int scenes = wanted_cases("EMBODY_ENERGY_SCENES", 60);
    ASSERT_GT(scenes, 0);
    for (int seed = 1; seed <= scenes; ++seed) {
        const auto world = random_scene(static_cast<std::uint64_t>(seed));
        const double start = energy(*world);
        double most = start;
        for (int i = 0; i < 600; ++i) {
            world->step();
            most = std::max(most, energy(*world));
        }
        EXPECT_LE(most, start * (1 + allowed_gain)) << "seed " << seed;
        EXPECT_EQ(world->last_report().limits & static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen), 0u);
    }
}

}  // namespace
}  // namespace embody::physics
