// SPDX-License-Identifier: MIT
// Energy of random scenes without motors never rises above what they began with. Each run does a few scenes;
//     EMBODY_ENERGY_SCENES=1000 test_validation --gtest_filter=RandomScenes.*
// does so many.
#include <gtest/gtest.h>

#include <cstdlib>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

ShapeDefinition random_shape(Random& random) {
    const double a = random.between(0.1, 0.5), b = random.between(0.1, 0.5), c = random.between(0.1, 0.5);
    HullShape hull;
    switch (random.below(6)) {
        case 0:
            return SphereShape{a};
        case 1:
            return BoxShape{{a, b, c}};
        case 2:
            return CapsuleShape{a, b};
        case 3:
            return CylinderShape{a, b};
        case 4:
            return ConeShape{a, b};
        default:
            for (int i = 0; i < 12; ++i) {
                hull.points.push_back({random.between(-a, a), random.between(-b, b), random.between(-c, c)});
            }
            return hull;
    }
}

// 4 to 20 bodies thrown into the air over a plane, none of them in another.
std::unique_ptr<World> random_scene(std::uint64_t seed) {
    Random random(seed);
    auto world = make_world({});
    add_plane(*world, {.restitution = random.unit()});
    const int count = 4 + static_cast<int>(random.below(17));
    for (int i = 0; i < count; ++i) {
        const auto shape = world->create_shape(random_shape(random)).value();
        const double mu = random.between(0, 1);
        const Vec3 place{random.between(-1, 1), 1 + 1.6 * i, random.between(-1, 1)};
        const Quat turn{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const auto body = world->create_body(
            {.shape = shape,
             .position = place,
             .rotation = normalized(turn),
             .linear_velocity = {random.between(-3, 3), random.between(-3, 3), random.between(-3, 3)},
             .angular_velocity = {random.between(-5, 5), random.between(-5, 5), random.between(-5, 5)},
             .mass = {.density = random.between(100, 5000)},
             .material = {.friction_static = mu, .friction_dynamic = mu, .restitution = random.unit()}});
        EXPECT_TRUE(body);
    }
    return world;
}

TEST(RandomScenes, NeverRiseAboveTheEnergyTheyBeganWith) {
    const char* wish = std::getenv("EMBODY_ENERGY_SCENES");
    const int scenes = wish != nullptr ? std::atoi(wish) : 30;
    ASSERT_GT(scenes, 0);
    for (int seed = 1; seed <= scenes; ++seed) {
        const auto world = random_scene(static_cast<std::uint64_t>(seed));
        const double start = energy(*world);
        double most = start;
        for (int i = 0; i < 300; ++i) {
            world->step();
            most = std::max(most, energy(*world));
        }
        EXPECT_LE(most, start * 1.001) << "seed " << seed;
        EXPECT_EQ(world->last_report().limits & static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen), 0u);
    }
}

}  // namespace
}  // namespace embody::physics
