// SPDX-License-Identifier: MIT
// A steady step allocates nothing: counted by this program's own operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "make_world.h"
#include "physics/inter/world.h"

namespace {

std::atomic<std::size_t> allocations{0};

void* allocate(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace embody::physics::stages {
namespace {

// Of `steps`, after others that fill the memory.
std::size_t count_allocations(World& world, int others, int steps, std::size_t* impacts = nullptr) {
    for (int i = 0; i < others; ++i) world.step();
    const std::size_t before = allocations;
    for (int i = 0; i < steps; ++i) {
        const StepReport& report = world.step();
        if (impacts != nullptr) *impacts += report.impacts;
    }
    return allocations - before;
}

TEST(SteadyAllocation, BallsThatRollInABowlNeedNone) {
    auto world = make_world({.workers = 1});
    constexpr int cells = 60;
    constexpr double pitch = 0.05, radius = 2;
    HeightfieldShape field{cells + 1, cells + 1, pitch, pitch, {}};
    for (int row = 0; row <= cells; ++row) {
        for (int column = 0; column <= cells; ++column) {
            const double x = (column - cells / 2) * pitch, z = (row - cells / 2) * pitch;
            field.heights.push_back(static_cast<float>((x * x + z * z) / (2 * radius)));
        }
    }
    const double corner = -cells / 2 * pitch;
    ASSERT_TRUE(world->create_body(
        {.kind = BodyKind::static_body, .shape = world->create_shape(field).value(), .position = {corner, 0, corner}}));
    const auto ball = world->create_shape(SphereShape{0.05}).value();
    for (int i = 0; i < 4; ++i) {
        const double distance = 0.3 + 0.2 * i;
        ASSERT_TRUE(world->create_body({.shape = ball,
                                        .position = {distance, distance * distance / (2 * radius) + 0.051, 0},
                                        .linear_velocity = {0, 0, distance * std::sqrt(9.81 / radius)},
                                        .allow_sleep = false}));
    }
    EXPECT_EQ(count_allocations(*world, 1200, 300), 0U);
}

// Two chains of heavy boxes, of two and of three links, with light balls that bounce between them: impacts of the one
// and of the other take turns.
TEST(SteadyAllocation, ImpactsOfTwoJointedAssembliesNeedNone) {
    auto world = make_world({.gravity = {}, .air_density = 0, .workers = 1});
    const auto box = world->create_shape(BoxShape{{0.2, 0.4, 0.4}}).value();
    const auto sphere = world->create_shape(SphereShape{0.05}).value();
    const Material bouncy{.friction_static = 0,
                          .friction_dynamic = 0,
                          .restitution = 1,
                          .friction_combine = CombineRule::geometric_mean,
                          .restitution_combine = CombineRule::multiply};
    for (const int links : {2, 3}) {
        const double x = links == 2 ? -0.32 : 0.32;
        BodyHandle above;
        for (int i = 0; i < links; ++i) {
            const auto link = world
                                  ->create_body({.shape = box,
                                                 .position = {x, -static_cast<double>(i), 0},
                                                 .mass = {.mass = 1e6},
                                                 .material = bouncy,
                                                 .allow_sleep = false})
                                  .value();
            const Vec3 hook = i == 0 ? Vec3{x, 0.5, 0} : Vec3{0, -0.5, 0};
            ASSERT_TRUE(world->create_joint({.joint = BallJoint{},
                                             .body_a = above,
                                             .body_b = link,
                                             .frame_a = {hook, {}},
                                             .frame_b = {{0, 0.5, 0}, {}}}));
            above = link;
        }
    }
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(world->create_body({.shape = sphere,
                                        .position = {0, -static_cast<double>(i), 0},
                                        .linear_velocity = {1.0 + 0.3 * i, 0, 0},
                                        .mass = {.mass = 1e-3},
                                        .material = bouncy,
                                        .allow_sleep = false}));
    }
    std::size_t impacts = 0;
    EXPECT_EQ(count_allocations(*world, 600, 300, &impacts), 0U);
    EXPECT_GT(impacts, 50U);
}

}  // namespace
}  // namespace embody::physics::stages
