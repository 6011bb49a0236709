// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "foundation/random.h"
#include "physics/definitions/grain_material.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// A heap of spheres and boxes dropped on a plane.
std::unique_ptr<World> make_heap(const WorldSettings& settings = {}) {
    auto world = make_world(settings);
    add_plane(*world, friction(0.5));
    const auto ball = world->create_shape(SphereShape{0.3}).value();
    const auto box = world->create_shape(BoxShape{{0.3, 0.3, 0.3}}).value();
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        EXPECT_TRUE(world->create_body(
            {.shape = i % 2 ? ball : box,
             .position = {random.between(-1, 1), 0.5 + 0.4 * i, random.between(-1, 1)},
             .material = {.friction_rolling = 0.03, .friction_torsional = 0.03, .restitution = 0.3}}));
    }
    return world;
}

TEST(Determinism, SameInputGivesTheSameBits) {
    const auto first = make_heap(), second = make_heap();
    for (int i = 0; i < 300; ++i) {
        first->step();
        second->step();
        ASSERT_EQ(first->state_hash(), second->state_hash()) << "step " << i;
    }
}

TEST(Determinism, AnyNumberOfLanesGivesTheSameBits) {
    const auto four = make_heap({.lanes = 4});
    std::vector<std::unique_ptr<World>> wider;
    for (const int lanes : {8, 16}) {
        if (auto world = World::create({.lanes = lanes})) wider.push_back(make_heap({.lanes = lanes}));
    }
    if (wider.empty()) GTEST_SKIP() << "this processor has no wider registers";
    for (int i = 0; i < 300; ++i) {
        four->step();
        for (const auto& world : wider) {
            world->step();
            ASSERT_EQ(four->state_hash(), world->state_hash()) << world->settings().lanes << " lanes, step " << i;
        }
    }
}

// Grains of random size and slope that drop gently, roll and come to rest: of a batch of contacts some are loaded and
// others not, and which share a batch depends on the number of lanes. Null where the processor has not as many.
std::unique_ptr<World> make_grains(std::uint64_t seed, int lanes) {
    auto made = World::create({.substeps = 12, .lanes = lanes});
    if (!made) return nullptr;
    auto world = std::move(made).value();
    Random random(seed);
    const double diameter = 0.01 * std::pow(10.0, random.unit());
    const Material material = grain_material(random.between(15, 45), diameter);
    add_plane(*world, material);
    const auto ball = world->create_shape(SphereShape{diameter / 2}).value();
    for (int i = 0; i < 60; ++i) {
        const double x = random.between(-2, 2), z = random.between(-2, 2);
        EXPECT_TRUE(world->create_body({.shape = ball,
                                        .position = diameter * Vec3{x, 0.6 + 0.5 * i, z},
                                        .mass = {.density = 2650},
                                        .material = material}));
    }
    return world;
}

TEST(Determinism, GrainsRollInTheSameWayWithAnyNumberOfLanes) {
    bool is_compared = false;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const auto four = make_grains(seed, 4);
        std::vector<std::unique_ptr<World>> wider;
        for (const int lanes : {8, 16})
            if (auto world = make_grains(seed, lanes)) wider.push_back(std::move(world));
        is_compared = is_compared || !wider.empty();
        for (int i = 0; i < 300; ++i) {
            four->step();
            for (const auto& world : wider) {
                world->step();
                ASSERT_EQ(four->state_hash(), world->state_hash())
                    << "seed " << seed << ", " << world->settings().lanes << " lanes, step " << i;
            }
        }
    }
    if (!is_compared) GTEST_SKIP() << "this processor has no wider registers";
}

// A pile that is large enough for all workers to take part.
std::unique_ptr<World> make_large_heap(int workers) {
    auto world = make_world({.workers = workers});
    add_plane(*world, friction(0.5));
    const auto box = world->create_shape(BoxShape{{0.3, 0.2, 0.25}}).value();
    Random random(9);
    for (int i = 0; i < 1200; ++i) {
        EXPECT_TRUE(world->create_body({.shape = box,
                                        .position = {random.between(-4, 4), 0.3 + 0.002 * i, random.between(-4, 4)},
                                        .material = {.restitution = i % 3 ? 0.0 : 0.5}}));
    }
    return world;
}

TEST(Determinism, AnyNumberOfWorkersGivesTheSameBits) {
    const auto one = make_large_heap(1);
    std::vector<std::unique_ptr<World>> others;
    for (const int workers : {0, 2, 3, 8}) others.push_back(make_large_heap(workers));
    for (int i = 0; i < 30; ++i) {
        one->step();
        for (const auto& world : others) {
            world->step();
            ASSERT_EQ(one->state_hash(), world->state_hash()) << world->settings().workers << " workers, step " << i;
        }
    }
}

TEST(Determinism, ANumberOfWorkersThatChangesFromStepToStepGivesTheSameBits) {
    // As where other programs need the cores by turns.
    const auto one = make_large_heap(1), other = make_large_heap(1);
    Random random(3);
    for (int i = 0; i < 30; ++i) {
        for (World* world : {one.get(), other.get()}) {
            WorldSettings settings = world->settings();  // set in both, since bodies wake by it
            if (world == other.get()) settings.workers = 1 + static_cast<int>(random.below(5));
            ASSERT_TRUE(world->set_settings(settings));
            world->step();
        }
        ASSERT_EQ(one->state_hash(), other->state_hash()) << other->settings().workers << " workers, step " << i;
        EXPECT_EQ(other->last_report().workers, other->settings().workers);
    }
}

TEST(Determinism, AnotherInputGivesOtherBits) {
    const auto first = make_heap(), second = make_heap();
    ASSERT_TRUE(second->set_velocity(second->bodies()[1], {1e-9, 0, 0}, {}));
    first->step();
    second->step();
    EXPECT_NE(first->state_hash(), second->state_hash());
}

TEST(Pile, ComesToRestAndSleepsWithoutPassingThroughTheFloor) {
    const auto world = make_heap();
    const double start = energy(*world);
    for (int i = 0; i < 60 * 20; ++i) {
        world->step();
        ASSERT_LE(energy(*world), start * (1 + 1e-3)) << "step " << i;
    }
    for (const BodyHandle body : world->bodies()) EXPECT_GT(world->pose(body).position.y, -0.01);
    EXPECT_EQ(world->last_report().limits & static_cast<std::uint32_t>(StepLimit::not_finite_body_frozen), 0u);
    EXPECT_EQ(world->last_report().bodies_asleep, 60u);
}

}  // namespace
}  // namespace embody::physics
