// SPDX-License-Identifier: MIT
// A collision takes energy, whatever the bodies' shapes, spins, friction and bounce. Each run tries some random ones;
//     EMBODY_IMPACT_CASES=100000 test_validation --gtest_filter=RandomImpacts.*
// as many (ctest --preset laws).
#include <gtest/gtest.h>

#include "validation/random_scenes.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double allowed_gain = 1e-6;  // in a step, of the energy that came in

TEST(RandomImpacts, NeverGainEnergyInAStep) {
    const int cases = wanted_cases("EMBODY_IMPACT_CASES", 5000);
    ASSERT_GT(cases, 0);
    for (int seed = 1; seed <= cases; ++seed) {
        const auto [world, steps] = random_impact(static_cast<std::uint64_t>(seed));
        const double start = energy(*world);
        double last = start;
        for (int i = 0; i < steps; ++i) {
            world->step();
            const double now = energy(*world);
            ASSERT_LE(now, last + allowed_gain * start) << "seed " << seed << ", step " << i;
            last = now;
        }
    }
}

/// A thin rod thrown at a plane, elastic and without friction: all of its energy stays, from bounce to bounce.
TEST(ElasticRod, KeepsItsEnergyFromBounceToBounce) {
    double sum = 0;
    const int rods = 300;
    for (int seed = 1; seed <= rods; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const auto world = make_world({.gravity = {}});
        const Material elastic{.friction_static = 0, .friction_dynamic = 0, .restitution = 1};
        add_plane(*world, elastic);
        const auto rod = world->create_body({.shape = world->create_shape(BoxShape{{0.02, 0.2, 0.02}}).value(),
                                             .position = {0, 0.255 + random.between(0, 0.05), 0},
                                             .rotation = random_rotation(random),
                                             .linear_velocity = {0, -3, 0},
                                             .angular_velocity = random_direction(random) * 50,
                                             .material = elastic});
        ASSERT_TRUE(rod);
        const double start = energy(*world);
        run(*world, 1);
        sum += energy(*world) / start;
    }
    EXPECT_NEAR(sum / rods, 1, 0.003);
}

}  // namespace
}  // namespace embody::physics
