// SPDX-License-Identifier: MIT
// A poured heap comes to rest at the material's friction angle, whatever the size and number of the grains (one to a
// few thousand: single heaps of the same kind differ by a degree). A slab of grains on a rough plank stays where the
// plank is flatter than that, and runs off where it is steeper.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/definitions/grain_material.h"
#include "physics/inter/world.h"
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

// Heaps of one kind scatter by one or two degrees.
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

/// How far the grains of a slab, four layers high, have slid down a plank after a second, in diameters.
double slide_in_a_second(double friction_angle, double slope, double diameter, std::uint64_t seed) {
    WorldSettings settings;
    settings.substeps = substeps_for_grains(diameter, settings);
    const auto world = make_world(settings);
    const Quat turn = from_axis_angle({0, 0, 1}, slope * std::numbers::pi / 180);
    constexpr Vec3 half{2, 0.1, 1};
    BodyDefinition plank{.kind = BodyKind::static_body, .position = rotate(turn, {0, -half.y, 0}), .rotation = turn};
    plank.material.friction_static = plank.material.friction_dynamic = 0.9;
    plank.shape = world->create_shape(BoxShape{half}).value();
    EXPECT_TRUE(world->create_body(plank).ok());

    BodyDefinition grain{.shape = world->create_shape(SphereShape{diameter / 2}).value()};
    grain.material = grain_material(friction_angle, diameter);
    grain.mass.density = 2650;
    Random random(seed);
    std::vector<BodyHandle> grains;
    std::vector<Vec3> starts;
    constexpr int across = 20, deep = 14, layers = 4;
    for (int i = 0; i < across * deep * layers; ++i) {
        // Face-centred rows with a little room (docs/physics/grains.md: Filling).
        const int x = i % across, z = i / across % deep, y = i / across / deep;
        const auto shaken = [&](double place) { return (1.1 * place + random.between(-0.028, 0.028)) * diameter; };
        grain.position = rotate(turn, {shaken(x + 0.5 * ((z + y % 3) % 2)), shaken(0.5 + y * std::sqrt(2.0 / 3)),
                                       shaken((z + (y % 3) / 3.0) * std::sqrt(0.75))});
        grains.push_back(world->create_body(grain).value());
        starts.push_back(grain.position);
    }
    for (int step = 0; step < 60; ++step) world->step();
    const Vec3 down = rotate(turn, {-1, 0, 0});
    double mean = 0;
    for (std::size_t i = 0; i < grains.size(); ++i)
        mean += dot(world->center_of_mass(grains[i]) - starts[i], down) / static_cast<double>(grains.size());
    return mean / diameter;
}

// The lowest layer is no layer of rollers.
TEST(GrainSlab, StaysWhereThePlankIsFlatterThanTheFrictionAngleAndRunsOffWhereItIsSteeper) {
    Random random(41);
    for (std::uint64_t family = 0; family < 4; ++family) {
        const double angle = random.between(26, 38), diameter = random.between(0.01, 0.03);
        const double flat = angle - random.between(12, 16), steep = angle + random.between(6, 10);
        EXPECT_LT(slide_in_a_second(angle, flat, diameter, family), 2) << angle << "° on " << flat << "°";
        EXPECT_GT(slide_in_a_second(angle, steep, diameter, family), 10) << angle << "° on " << steep << "°";
    }
}

}  // namespace
}  // namespace embody::physics
