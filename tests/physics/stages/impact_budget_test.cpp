// SPDX-License-Identifier: MIT
// How many impacts a step may have: few enough to end, enough for what really collides.
#include <gtest/gtest.h>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::stages {
namespace {

constexpr double radius = 0.05;  // m
constexpr Material elastic{.friction_static = 0, .friction_dynamic = 0, .restitution = 1};

bool is_exhausted(const StepReport& report) {
    return (report.limits & static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted)) != 0;
}

// Between two plates a ball bounces on each of them as often as a contact may, and is stopped.
TEST(ImpactBudget, LetsEachContactHaveAllItsBounces) {
    const auto world = make_world({.gravity = {}, .air_density = 0});
    const double gap = 0.01, speed = 30;
    const auto plate = world->create_shape(BoxShape{{0.1, 0.5, 0.5}}).value();
    for (const double side : {-1, 1}) {
        ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body,
                                        .shape = plate,
                                        .position = {side * (0.1 + radius + gap), 0, 0},
                                        .material = elastic}));
    }
    const auto ball = world
                          ->create_body({.shape = world->create_shape(SphereShape{radius}).value(),
                                         .linear_velocity = {speed, 0, 0},
                                         .material = elastic})
                          .value();
    EXPECT_FALSE(is_exhausted(world->step()));
    EXPECT_NEAR(length(world->linear_velocity(ball)), 0, 1e-6);
}

// Many balls fall at once on others that lie on the floor: each bounces against a pile.
bool runs_out(std::size_t bodies_per_pile_bounce) {
    WorldSettings settings;
    ImpactBudgetSettings& budget = settings.solver.constraint.impact.budget;
    budget.pile_bounces = 1;
    budget.bodies_per_pile_bounce = bodies_per_pile_bounce;
    const auto world = World::create(settings).value();
    const auto floor = world->create_shape(PlaneShape{}).value();
    EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = floor}));
    const auto shape = world->create_shape(SphereShape{radius}).value();
    constexpr int count = 40;
    for (int i = 0; i < count; ++i) {
        const BodyDefinition lower{.shape = shape, .position = {4 * radius * i, radius, 0}, .allow_sleep = false};
        BodyDefinition upper = lower;
        upper.position.y = 3.5 * radius;
        upper.linear_velocity = {0, -1, 0};
        upper.material = elastic;
        EXPECT_TRUE(world->create_body(lower));
        EXPECT_TRUE(world->create_body(upper));
    }
    bool any = false;
    for (int i = 0; i < 10; ++i) any = any || is_exhausted(world->step());
    return any;
}

TEST(ImpactBudget, OfPilesGrowsWithTheAwakeBodies) {
    EXPECT_TRUE(runs_out(8));
    EXPECT_FALSE(runs_out(1));
}

}  // namespace
}  // namespace embody::physics::stages
