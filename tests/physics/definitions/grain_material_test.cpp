// SPDX-License-Identifier: MIT
#include "physics/definitions/grain_material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "physics/definitions/material.h"

namespace embody::physics {
namespace {

// docs/physics/grains.md: frictions that were measured to give a slope.
TEST(GrainMaterial, IsTheMeasuredOneAtItsSlopeAndBetweenTwoOfThemElsewhere) {
    constexpr double diameter = 0.01, rounding = 1e-12;
    for (const auto& [angle, sliding, rolling] :
         {std::array{6.5, 0.1, 0.005}, {19.6, 0.4, 0.005}, {34.9, 0.6, 0.035}}) {
        const Material material = grain_material(angle, diameter);
        EXPECT_NEAR(material.friction_static, sliding, rounding) << angle;
        EXPECT_NEAR(material.friction_rolling, rolling * diameter, rounding) << angle;
    }
    const Material between = grain_material((12.1 + 16.5) / 2, diameter);
    EXPECT_NEAR(between.friction_dynamic, 0.25, rounding);
}

TEST(GrainMaterial, OfASteeperHeapResistsAtLeastAsMuch) {
    for (const double diameter : {1e-4, 0.01, 1.0, 100.0}) {
        Material before = grain_material(0, diameter);
        for (double angle = -10; angle < 120; angle += 0.5) {
            const Material material = grain_material(angle, diameter);
            ASSERT_TRUE(validate(material)) << angle << " " << diameter;
            EXPECT_GE(material.friction_static, before.friction_static) << angle;
            EXPECT_GE(material.friction_rolling, before.friction_rolling) << angle;
            before = material;
        }
    }
}

// On one another they roll as measured; on a plank, a wall or a floor they slide before they roll: a ball on a slope
// rolls where the slope is more than twice the lever arm over the diameter.
TEST(GrainMaterial, RollsOnWhatIsNoGrainNotBeforeItSlides) {
    for (const double diameter : {1e-3, 0.01, 0.1}) {
        for (double angle = 7; angle < 45; angle += 4) {
            const Material grain = grain_material(angle, diameter), plank{.friction_rolling = 1e-5};
            const Material on_plank = combine(grain, plank, {}), on_grain = combine(grain, grain, {});
            EXPECT_EQ(on_grain.friction_rolling, grain.friction_rolling);
            EXPECT_EQ(on_grain.friction_rolling_on_others, 0);
            EXPECT_NEAR(2 * on_plank.friction_rolling_on_others / diameter,
                        std::min(grain.friction_static, 0.1 / diameter), 1e-12);
            EXPECT_EQ(combine(plank, grain, {}).friction_rolling_on_others, on_plank.friction_rolling_on_others);
            EXPECT_EQ(on_plank.friction_rolling, std::max(grain.friction_rolling, plank.friction_rolling));
        }
    }
}

TEST(GrainSubsteps, AreMoreForSmallerGrainsAndNeverFewerThanTheSettingsSay) {
    const WorldSettings settings;
    int before = 1000;
    for (const double diameter : {1e-4, 1e-3, 0.01, 0.1, 1.0, 10.0}) {
        const int substeps = substeps_for_grains(diameter, settings);
        EXPECT_LE(substeps, before) << diameter;
        EXPECT_GE(substeps, settings.substeps) << diameter;
        before = substeps;
    }
    EXPECT_EQ(substeps_for_grains(1e-9, settings), 16);
    EXPECT_EQ(substeps_for_grains(1e-9, {.substeps = 40}), 40);
    // Where nothing falls there is still a number.
    EXPECT_EQ(substeps_for_grains(1, {.gravity = {0, 0, 0}}), WorldSettings{}.substeps);
    // A fall of one diameter takes as long where both are 16 times as large.
    EXPECT_EQ(substeps_for_grains(0.16, {.gravity = {0, -160, 0}}),
              substeps_for_grains(0.01, {.gravity = {0, -10, 0}}));
}

}  // namespace
}  // namespace embody::physics
