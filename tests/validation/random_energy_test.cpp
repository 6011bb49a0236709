// SPDX-License-Identifier: MIT
// Energy of random scenes without motors never rises above what they began with. Each run does a few scenes;
//     EMBODY_ENERGY_SCENES=1000 test_validation --gtest_filter=RandomScenes.*
// does so many (ctest --preset laws).
#include <gtest/gtest.h>

#include "validation/random_bodies.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

void add_ground(World& world, const ShapeDefinition& shape, Vec3 position, const Material& material) {
    const auto handle = world.create_shape(shape).value();
    ASSERT_TRUE(world.create_body(
        {.kind = BodyKind::static_body, .shape = handle, .position = position, .material = material}));
}

MeshShape bumpy_mesh(Random& random) {
    constexpr std::uint32_t cells = 24;
    constexpr double pitch = 0.8, height = 0.3;
    MeshShape mesh;
    for (std::uint32_t i = 0; i <= cells; ++i) {
        for (std::uint32_t j = 0; j <= cells; ++j) {
            mesh.positions.push_back(
                to_vec3f({(i - cells / 2.0) * pitch, height * random.unit(), (j - cells / 2.0) * pitch}));
        }
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

/// A plane, a slab, a pen of planes or a bumpy mesh.
void add_random_ground(World& world, Random& random) {
    const Material material{.restitution = random.unit()};
    switch (random.below(4)) {
        case 0:
            return add_ground(world, PlaneShape{{0, 1, 0}, 0}, {}, material);
        case 1:
            return add_ground(world, BoxShape{{20, 1, 20}}, {0, -1, 0}, material);
        case 2:
            for (const Vec3 inward : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
                add_ground(world, PlaneShape{inward, inward.y > 0 ? 0.0 : -3.0}, {}, material);
            }
            return;
        default:
            return add_ground(world, bumpy_mesh(random), {}, material);
    }
}

// 2 to 20 bodies thrown into the air over a ground, none of them in another, fast and spinning in half of the scenes.
std::unique_ptr<World> random_scene(std::uint64_t seed) {
    Random random(seed);
    auto world = make_world({});
    add_random_ground(*world, random);
    const int count = 2 + static_cast<int>(random.below(19));
    const double spin = random.below(2) > 0 ? 5 : 50, speed = random.below(2) > 0 ? 3 : 15;
    for (int i = 0; i < count; ++i) {
        EXPECT_TRUE(world->create_body({.shape = world->create_shape(random_shape(random, 0.5)).value(),
                                        .position = {random.between(-1, 1), 1.5 + 1.8 * i, random.between(-1, 1)},
                                        .rotation = random_rotation(random),
                                        .linear_velocity = random_vector(random, speed),
                                        .angular_velocity = random_vector(random, spin),
                                        .mass = {.density = random.between(100, 5000)},
                                        .material = random_material(random)}));
    }
    return world;
}

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
