// SPDX-License-Identifier: MIT
// A poured heap comes to rest at the material's friction angle, whatever the size and number of the grains (one to a
// few thousand: single heaps of the same kind differ by a degree).
#include <gtest/gtest.h>

#include <cmath>

#include "make_world.h"
#include "physics/definitions/grain_material.h"
#include "scenes/structures/grain_heap.h"

namespace embody::physics {
namespace {

constexpr double tolerance = 2;  // degrees

// The mean slope of so many heaps that differ in where their grains fall.
void expect_slope(scenes::HeapToPour definition, int heaps = 1) {
    double angle = 0;
    for (int i = 0; i < heaps; ++i, ++definition.seed) {
        const auto heap = scenes::pour_heap(definition);
        ASSERT_TRUE(heap.ok()) << heap.error().message();
        angle += heap.value().angle / heaps;
        EXPECT_TRUE(heap.value().asleep);
        EXPECT_LT(heap.value().overlap, 0.12);
    }
    EXPECT_NEAR(angle, definition.friction_angle, tolerance)
        << definition.grains << " grains of " << definition.diameter << " m";
}

class GrainHeap : public testing::TestWithParam<double> {};

TEST_P(GrainHeap, HasTheFrictionAngleAsItsSlope) { expect_slope({.friction_angle = GetParam()}, 2); }
INSTANTIATE_TEST_SUITE_P(OfBeadsRiceSandAndGravel, GrainHeap, testing::Values(21, 27, 32, 38, 44));

// Heaps of one kind scatter by one degree; six of these are 30.7 to 33.5, in the mean 32.4.
TEST(GrainHeaps, SlopeTheSameForGrainsOfFiveMillimetres) { expect_slope({.diameter = 0.005}, 6); }
TEST(GrainHeaps, SlopeTheSameForGrainsOfThreeCentimetres) { expect_slope({.diameter = 0.03}, 3); }
TEST(GrainHeaps, SlopeTheSameForTwiceAsMany) { expect_slope({.grains = 3000}); }

TEST(GrainMaterial, HasMoreFrictionForSteeperAnglesAndRollingFrictionInProportionToTheSize) {
    Material last = grain_material(0, 0.01);
    for (double angle = 1; angle <= 80; angle += 1) {
        const Material material = grain_material(angle, 0.01);
        EXPECT_TRUE(validate(material).ok());
        EXPECT_GE(material.friction_dynamic, last.friction_dynamic);
        EXPECT_GE(material.friction_rolling, last.friction_rolling);
        EXPECT_NEAR(grain_material(angle, 0.02).friction_rolling, 2 * material.friction_rolling, 1e-12);
        last = material;
    }
}

TEST(GrainSteps, AreFinerForSmallerGrainsAndNeverCoarserThanAskedFor) {
    const WorldSettings settings = make_world()->settings();
    EXPECT_EQ(substeps_for_grains(0.1, settings), settings.substeps);
    EXPECT_GT(substeps_for_grains(0.003, settings), substeps_for_grains(0.01, settings));
    // Heaps come out steeper from 0.05 of the time on in which a grain falls its own diameter (docs/physics/grains.md).
    for (const double diameter : {0.003, 0.006, 0.01}) {
        const auto part = [&](int substeps) {  // twice as many in large islands
            return settings.time_step / (2 * substeps) / std::sqrt(diameter / length(settings.gravity));
        };
        const int substeps = substeps_for_grains(diameter, settings);
        EXPECT_LT(part(substeps), 0.05) << diameter;
        EXPECT_GT(part(substeps - 2), 0.05) << diameter;
    }
    WorldSettings fine;
    fine.substeps = 64;
    EXPECT_EQ(substeps_for_grains(0.003, fine), 64);
    WorldSettings weightless;
    weightless.gravity = {};
    EXPECT_EQ(substeps_for_grains(0.01, weightless), weightless.substeps);
}

}  // namespace
}  // namespace embody::physics
