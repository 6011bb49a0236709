// SPDX-License-Identifier: MIT
// The account of a step (docs/physics/energy.md) in cases where each entry is known by a formula.
#include <gtest/gtest.h>

#include <cmath>

#include "make_world.h"
#include "physics/inter/world.h"

namespace embody::physics::state {
namespace {

constexpr double g = 9.81;

std::unique_ptr<World> world_of_gravity(Vec3 gravity) {
    WorldSettings settings;
    settings.gravity = gravity;
    settings.air_density = 0;
    auto world = make_world(settings);
    world->keep_account(true);
    return world;
}

BodyHandle add_box(World& world, const BodyDefinition& definition) {
    BodyDefinition box = definition;
    box.shape = world.create_shape(BoxShape{{0.5, 0.5, 0.5}}).value();
    return world.create_body(box).value();
}

void add_floor(World& world, const Material& material, Vec3 velocity = {}) {
    BodyDefinition floor{.kind = velocity == Vec3{} ? BodyKind::static_body : BodyKind::kinematic_body,
                         .linear_velocity = velocity,
                         .material = material};
    floor.shape = world.create_shape(BoxShape{{50, 1, 50}}).value();
    floor.position = {0, -1, 0};
    ASSERT_TRUE(world.create_body(floor));
}

Material friction(double mu) {
    return {.friction_static = mu, .friction_dynamic = mu, .friction_combine = CombineRule::geometric_mean};
}

struct Sums {
    std::array<double, static_cast<std::size_t>(StepCause::count)> work{};
    double unexplained = 0;
    [[nodiscard]] double of(StepCause cause) const { return work[static_cast<std::size_t>(cause)]; }
};
Sums run(World& world, int steps) {
    Sums sums;
    for (int i = 0; i < steps; ++i) {
        const StepAccount& account = *world.step().account;
        for (std::size_t k = 0; k < sums.work.size(); ++k) sums.work[k] += account.entries[k].work;
        sums.unexplained += account.unexplained_energy;
    }
    return sums;
}

TEST(StepAccount, IsThereOnlyWhenAskedFor) {
    const auto world = world_of_gravity({0, -g, 0});
    EXPECT_TRUE(world->step().account);
    world->keep_account(false);
    EXPECT_FALSE(world->step().account);
}

TEST(StepAccount, OfFreeFallIsGravitys) {
    const auto world = world_of_gravity({0, -g, 0});
    add_box(*world, {.position = {3, 5, 0}, .angular_velocity = {3, 2, 1}, .mass = {.mass = 2.0}});
    const StepAccount& account = *world->step().account;
    const double dt = world->settings().time_step;
    EXPECT_NEAR(account.of(StepCause::gravity).work, 2 * g * g * dt * dt / 2, 1e-12);
    EXPECT_NEAR(account.of(StepCause::gravity).linear_impulse.y, -2 * g * dt, 1e-12);
    EXPECT_NEAR(account.of(StepCause::gravity).angular_impulse.z, -3 * 2 * g * dt, 1e-12);
    EXPECT_NEAR(account.unexplained_energy, 0, 1e-12);
    EXPECT_NEAR(length(account.unexplained_linear_momentum), 0, 1e-12);
    EXPECT_NEAR(length(account.unexplained_angular_momentum), 0, 1e-12);
    EXPECT_DOUBLE_EQ(account.before.potential_energy, 2 * g * 5);
    EXPECT_NEAR(account.after.energy(), account.before.energy(), 1e-10);
}

/// A block slides: friction does −µ m g d, and its impulse is the ground's.
TEST(StepAccount, OfASlidingBlockIsFrictions) {
    const auto world = world_of_gravity({0, -g, 0});
    add_floor(*world, friction(0.3));
    const BodyHandle block =
        add_box(*world, {.position = {0, 0.5, 0}, .mass = {.mass = 2.0}, .material = friction(0.3)});
    run(*world, 30);
    ASSERT_TRUE(world->set_velocity(block, {4, 0, 0}, {}));
    const double start = world->center_of_mass(block).x;
    const Sums sums = run(*world, 30);
    const double travel = world->center_of_mass(block).x - start;
    EXPECT_NEAR(sums.of(StepCause::contacts), -0.3 * 2 * g * travel, 0.01 * 0.3 * 2 * g * travel);
    EXPECT_NEAR(sums.unexplained, 0, 1e-3);
    const StepAccount& account = *world->last_report().account;
    EXPECT_NEAR(account.of(StepCause::contacts).linear_impulse.x, -0.3 * 2 * g / 60, 1e-3);
    EXPECT_NEAR(length(account.unexplained_linear_momentum), 0, 1e-5);
}

/// A conveyor belt brings a block to its speed v: it gives m v², and half of that becomes heat.
TEST(StepAccount, OfAMovingGroundIsItsOwnEntry) {
    const auto world = world_of_gravity({0, -g, 0});
    add_floor(*world, friction(0.5), {2, 0, 0});
    add_box(*world, {.position = {0, 0.5, 0}, .mass = {.mass = 3.0}, .material = friction(0.5)});
    const Sums sums = run(*world, 60);
    EXPECT_NEAR(sums.of(StepCause::moving_bodies), 3 * 2 * 2, 0.3);
    EXPECT_NEAR(sums.of(StepCause::contacts), -3 * 2 * 2 / 2.0, 0.3);
    EXPECT_NEAR(sums.unexplained, 0, 1e-2);
}

TEST(StepAccount, OfAnImpactIsItsLoss) {
    const auto world = world_of_gravity({});
    const Material half{.friction_static = 0, .friction_dynamic = 0, .restitution = 0.5};
    add_floor(*world, half);
    add_box(*world, {.position = {0, 1, 0}, .linear_velocity = {0, -4, 0}, .mass = {.mass = 2.0}, .material = half});
    const Sums sums = run(*world, 30);
    EXPECT_NEAR(sums.of(StepCause::impacts), -(1 - 0.25) * 2 * 4 * 4 / 2.0, 1e-6);
    EXPECT_NEAR(sums.unexplained, 0, 1e-9);
}

TEST(StepAccount, OfForcesAndDampingAreTheirWork) {
    const auto world = world_of_gravity({});
    const BodyHandle box = add_box(*world, {.linear_velocity = {1, 0, 0}, .mass = {.mass = 2.0}});
    ASSERT_TRUE(world->set_force(box, {6, 0, 0}, {0, 0.1, 0}));
    const double start = world->center_of_mass(box).x;
    const Sums pushed = run(*world, 60);
    const double turn_work = 0.1 * 0.1 / (2 * world->inertia(box).y.y);
    EXPECT_NEAR(pushed.of(StepCause::forces), 6 * (world->center_of_mass(box).x - start) + turn_work, 1e-3);
    EXPECT_NEAR(pushed.unexplained, 0, 1e-9);

    BodyDefinition damped = *world->body(box);
    damped.force = damped.torque = {};
    damped.linear_damping = damped.angular_damping = 0.7;
    ASSERT_TRUE(world->set_body(box, damped));
    const double before = world->conserved().kinetic_energy;
    const Sums sums = run(*world, 60);
    EXPECT_NEAR(sums.of(StepCause::damping), world->conserved().kinetic_energy - before, 1e-6 * before);
    EXPECT_NEAR(sums.unexplained, 0, 1e-6 * before);
}

/// A pendulum's joint does no work; its pull is what gravity does not explain of the momentum.
TEST(StepAccount, OfAPendulumsJointIsNothing) {
    const auto world = world_of_gravity({0, -g, 0});
    const BodyHandle bob = add_box(*world, {.position = {2, 0, 0}, .mass = {.mass = 2.0}});
    JointDefinition joint{.joint = BallJoint{}, .body_b = bob};
    joint.frame_b.position = {-2, 0, 0};
    ASSERT_TRUE(world->create_joint(joint));
    for (int i = 0; i < 120; ++i) {
        const StepAccount& account = *world->step().account;
        EXPECT_NEAR(account.of(StepCause::joints).work, 0, 1e-3);
        EXPECT_NEAR(account.unexplained_energy, 0, 1e-2);
        EXPECT_NEAR(length(account.unexplained_linear_momentum), 0, 1e-9);
    }
}

TEST(StepAccount, OfAMotorIsItsTorqueTimesTheTurn) {
    const auto world = world_of_gravity({});
    const BodyHandle wheel = add_box(*world, {.mass = {.mass = 2.0}});
    HingeJoint hinge;
    hinge.motor = JointMotor{100, 0.5};
    ASSERT_TRUE(world->create_joint({.joint = hinge, .body_b = wheel}));
    const Sums sums = run(*world, 60);
    EXPECT_NEAR(sums.of(StepCause::motors), world->conserved().kinetic_energy, 1e-6);
    EXPECT_GT(sums.of(StepCause::motors), 0.1);
    EXPECT_NEAR(sums.unexplained, 0, 1e-6);
}

// A ball strikes a box on a hinge off its middle: the hinge leads the blow on to what holds it.
StepAccount account_of_blow(const HingeJoint& hinge, Vec3 carrier_velocity) {
    const auto world = world_of_gravity({});
    const Material bouncy{
        .friction_static = 0, .friction_dynamic = 0, .restitution = 0.5, .restitution_combine = CombineRule::maximum};
    const BodyHandle carrier =
        world->create_body({.kind = BodyKind::kinematic_body, .linear_velocity = carrier_velocity}).value();
    const BodyHandle box = add_box(
        *world, {.linear_velocity = carrier_velocity, .mass = {.mass = 2.0}, .material = bouncy, .allow_sleep = false});
    EXPECT_TRUE(world->create_joint({.joint = hinge,
                                     .body_a = carrier_velocity == Vec3{} ? BodyHandle{} : carrier,
                                     .body_b = box,
                                     .frame_a = {{0, 0, 0.3}, {}},
                                     .frame_b = {{0, 0, 0.3}, {}}}));
    BodyDefinition ball{.position = {0.2, 0.605, 0},
                        .linear_velocity = {carrier_velocity.x, -1, 0},
                        .mass = {.mass = 1.0},
                        .material = bouncy,
                        .allow_sleep = false};
    ball.shape = world->create_shape(SphereShape{0.1}).value();
    EXPECT_TRUE(world->create_body(ball));
    const StepReport& report = world->step();
    EXPECT_EQ(report.impacts, 1U);
    return *report.account;
}

TEST(StepAccount, BooksTheImpactOnAJointWithAMotorAsTheMotors) {
    HingeJoint hinge;
    const StepAccount free = account_of_blow(hinge, {});
    EXPECT_GT(free.of(StepCause::joints).linear_impulse.y, 0.1);
    EXPECT_EQ(free.of(StepCause::motors).linear_impulse, Vec3{});
    hinge.motor = JointMotor{0, 0.5};
    const StepAccount driven = account_of_blow(hinge, {});
    EXPECT_EQ(driven.of(StepCause::joints).linear_impulse, Vec3{});
    EXPECT_EQ(driven.of(StepCause::joints).angular_impulse, Vec3{});
    EXPECT_GT(driven.of(StepCause::motors).linear_impulse.y, 0.1);
    for (const StepAccount& account : {free, driven}) {
        EXPECT_NEAR(account.unexplained_linear_momentum.y, 0, 1e-5);
        EXPECT_NEAR(length(account.unexplained_angular_momentum), 0, 1e-3);
        EXPECT_NEAR(account.unexplained_energy, 0, 1e-4);
    }
}

TEST(StepAccount, BooksTheWorkOfAMovingCarrierInAnImpact) {
    for (const Vec3 velocity : {Vec3{5, 0, 0}, Vec3{0, 5, 0}, Vec3{0, 0.3, 0}}) {
        const StepAccount account = account_of_blow({}, velocity);
        EXPECT_NEAR(account.unexplained_energy, 0, 1e-4) << velocity.x << " " << velocity.y;
    }
}

TEST(StepAccount, NamesWhatWasCutAndWhatFellAsleep) {
    WorldSettings settings;
    settings.gravity = {};
    settings.max_linear_speed = 10;
    auto world = make_world(settings);
    world->keep_account(true);
    const BodyHandle box = add_box(*world, {.linear_velocity = {20, 0, 0}, .mass = {.mass = 2.0}});
    EXPECT_NEAR(world->step().account->of(StepCause::limits).work, 2 * (100 - 400) / 2.0, 1e-9);
    ASSERT_TRUE(world->set_velocity(box, {1e-4, 0, 0}, {}));
    const Sums sums = run(*world, 120);
    EXPECT_NEAR(sums.of(StepCause::sleep), -2 * 1e-8 / 2, 1e-12);
    EXPECT_NEAR(sums.unexplained, 0, 1e-12);
}

TEST(StepAccount, ChangesNoBit) {
    const auto hash_after = [](bool is_wanted) {
        const auto world = world_of_gravity({0, -g, 0});
        world->keep_account(is_wanted);
        add_floor(*world, friction(0.5));
        for (int i = 0; i < 20; ++i) {
            add_box(*world, {.position = {0.3 * (i % 3), 1 + 1.2 * i, 0.2 * (i % 2)}, .angular_velocity = {1, 2, 3}});
        }
        for (int i = 0; i < 120; ++i) world->step();
        return world->state_hash();
    };
    EXPECT_EQ(hash_after(true), hash_after(false));
}

}  // namespace
}  // namespace embody::physics::state
