// SPDX-License-Identifier: MIT
// A collision takes energy, whatever the bodies' shapes, spins, friction and bounce. Each run tries some random ones;
//     EMBODY_IMPACT_CASES=100000 test_validation --gtest_filter=RandomImpacts.*
// as many (ctest --preset laws).
#include <gtest/gtest.h>

#include <algorithm>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double allowed_gain = 1e-6;  // in a step, of the energy that came in

MeshShape slab_of_triangles() {
    MeshShape mesh;
    constexpr std::uint32_t cells = 8;
    for (std::uint32_t i = 0; i <= cells; ++i) {
        for (std::uint32_t j = 0; j <= cells; ++j) mesh.positions.push_back(to_vec3f({i * 0.5 - 2, 0, j * 0.5 - 2}));
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t a = i * (cells + 1) + j, c = a + cells + 1;
            mesh.triangles.push_back({a, a + 1, c});
            mesh.triangles.push_back({a + 1, c + 1, c});
        }
    }
    return mesh;
}

/// What something is thrown at: a plane, a slab, a mesh or a ball that stand still, or any shape that floats freely and
/// spins.
void add_target(World& world, Random& random, const Material& material) {
    BodyDefinition target{.kind = BodyKind::static_body, .material = material};
    ShapeDefinition shape = PlaneShape{{0, 1, 0}, 0};
    switch (random.below(5)) {
        case 0:
            break;
        case 1:
            shape = BoxShape{{5, 1, 5}};
            target.position.y = -1;
            break;
        case 2:
            shape = slab_of_triangles();
            break;
        case 3:
            shape = SphereShape{0.5};
            target.position.y = -0.5;
            break;
        default:
            shape = random_shape(random, 0.5);
            target.kind = BodyKind::dynamic_body;
            target.position.y = -0.9;
            target.rotation = random_rotation(random);
            target.angular_velocity = random_direction(random) * random.between(0, 100);
            target.mass.mass = random.between(0.1, 100);
    }
    target.shape = world.create_shape(shape).value();
    EXPECT_TRUE(world.create_body(target));
}

TEST(RandomImpacts, NeverGainEnergyInAStep) {
    const int cases = wanted_cases("EMBODY_IMPACT_CASES", 5000);
    ASSERT_GT(cases, 0);
    for (int seed = 1; seed <= cases; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const auto world = make_world({.gravity = {}});
        const Material material = random_material(random);
        add_target(*world, random, material);
        const double size = random.between(0.05, 0.5), speed = random.between(0.1, 10);
        const double height = 1.8 * size + random.between(0, speed * world->settings().time_step);
        const auto body = world->create_body({.shape = world->create_shape(random_shape(random, size)).value(),
                                              .position = {0, height, 0},
                                              .rotation = random_rotation(random),
                                              .linear_velocity = {random.between(-speed, speed), -speed, 0},
                                              .angular_velocity = random_direction(random) * random.between(0, 100),
                                              .mass = {.mass = random.between(0.1, 10)},
                                              .material = material});
        ASSERT_TRUE(body);

        // Until it has come, and gone or come to rest.
        const int steps = std::min(400, 20 + static_cast<int>(4 * height / speed / world->settings().time_step));
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
