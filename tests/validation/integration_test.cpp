// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

TEST(Integration, FreeFallFollowsTheParabolaExactly) {
    const auto reference = reference_case("free_fall");
    const auto world = make_world({.time_step = 1.0 / 60});
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    const auto body = world->create_body({.shape = ball, .position = {0, 20, 0}}).value();
    run(*world, 2);
    EXPECT_NEAR(world->pose(body).position.y, reference["expected"]["y"].get<double>(), 1e-9);
    EXPECT_NEAR(world->linear_velocity(body).y, reference["expected"]["v"].get<double>(), 1e-9);
}

TEST(Integration, TumblingBoxKeepsEnergyAndAngularMomentum) {
    const auto reference = reference_case("tumble_conservation");
    const auto world = make_world({.gravity = {}, .time_step = 0.01});
    const auto box = world->create_shape(BoxShape{to_vec3(reference["setup"]["half_extents"])}).value();
    const auto body =
        world->create_body({.shape = box, .angular_velocity = {1, 2, 3}, .mass = {.mass = 1}, .allow_sleep = false})
            .value();
    const Conserved before = world->conserved();
    EXPECT_NEAR(before.kinetic_energy, reference["expected"]["energy"].get<double>(), 1e-10);
    const auto body_rate = [&] { return rotate_inverse(world->pose(body).rotation, world->angular_velocity(body)); };

    run(*world, 1);
    const double tolerance = reference["tolerance"]["omega_abs"];
    EXPECT_LT(length(body_rate() - to_vec3(reference["expected"]["omega_body_t1"])), tolerance);
    run(*world, 4);
    EXPECT_LT(length(body_rate() - to_vec3(reference["expected"]["omega_body_t5"])), tolerance);
    const Conserved after = world->conserved();
    EXPECT_NEAR(after.kinetic_energy / before.kinetic_energy, 1, 1e-9);
    EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-9 * length(before.angular_momentum));
}

TEST(Integration, SymmetricBodyPrecessesAtItsRate) {
    const auto reference = reference_case("symmetric_precession");
    const auto& expected = reference["expected"];
    const auto world = make_world({.gravity = {}, .time_step = 1.0 / 240});
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    const auto body = world
                          ->create_body({.shape = ball,
                                         .angular_velocity = {2, 0, 10},
                                         .mass = {.mass = 1, .inertia = Mat3::diagonal({0.02, 0.02, 0.03})},
                                         .allow_sleep = false})
                          .value();

    // The symmetry axis turns about the angular momentum at the space rate.
    const Vec3 axis_of_cone = normalized(world->conserved().angular_momentum);
    const auto across = [&] {
        const Vec3 axis = rotate(world->pose(body).rotation, {0, 0, 1});
        return axis - dot(axis, axis_of_cone) * axis_of_cone;
    };
    const double tilt = std::atan2(length(across()), dot(rotate(world->pose(body).rotation, {0, 0, 1}), axis_of_cone));
    EXPECT_NEAR(tilt * 180 / pi, expected["half_angle_deg"].get<double>(), 1e-6);
    double angle = 0;
    const double seconds = 2;
    for (int i = 0; i < 480; ++i) {
        const Vec3 before = across();
        world->step();
        const Vec3 after = across();
        angle += std::atan2(dot(cross(before, after), axis_of_cone), dot(before, after));
    }
    EXPECT_NEAR(angle / seconds, expected["space_rate"].get<double>(), 0.005 * expected["space_rate"].get<double>());
}

// A heavy small ball on a massless rod: a jointed body with next to no inertia of its own.
BodyHandle add_bob(World& world, Vec3 position, Vec3 velocity, Vec3 angular_velocity) {
    const double tiny = 1e-5;
    return world
        .create_body({.position = position,
                      .linear_velocity = velocity,
                      .angular_velocity = angular_velocity,
                      .mass = {.mass = 1, .inertia = Mat3::diagonal({tiny, tiny, tiny})},
                      .allow_sleep = false})
        .value();
}

TEST(Integration, PendulumFrom170DegreesHasItsPeriod) {
    const auto reference = reference_case("pendulum_170");
    const auto world = make_world({.time_step = 1.0 / 240});
    const double amplitude = 170 * pi / 180;
    const Vec3 start{std::sin(amplitude), -std::cos(amplitude), 0};
    const auto bob = add_bob(*world, start, {}, {});
    ASSERT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = bob, .frame_b = {-start, {}}}));

    // A quarter of the period until the lowest point, by linear interpolation.
    double last = start.x;
    for (int i = 0; i < 3 * 240; ++i) {
        world->step();
        const double x = world->pose(bob).position.x;
        if (x <= 0) {
            const double time = world->last_report().time - world->settings().time_step * x / (x - last);
            const double period = reference["expected"]["period"];
            EXPECT_NEAR(4 * time, period, 0.01 * period);
            return;
        }
        last = x;
    }
    FAIL() << "the pendulum never came down";
}

TEST(Integration, DoublePendulumFollowsLagrangesEquations) {
    const auto reference = reference_case("double_pendulum");
    const auto world = make_world({.time_step = 1.0 / 240});
    const auto first = add_bob(*world, {1, 0, 0}, {}, {});
    const auto second = add_bob(*world, {2, 0, 0}, {}, {});
    ASSERT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = first, .frame_b = {{-1, 0, 0}, {}}}));
    ASSERT_TRUE(
        world->create_joint({.joint = BallJoint{}, .body_a = first, .body_b = second, .frame_b = {{-1, 0, 0}, {}}}));
    const auto angles = [&] {
        const Vec3 p = world->pose(first).position, q = world->pose(second).position - p;
        return std::pair(std::atan2(p.x, -p.y), std::atan2(q.x, -q.y));
    };
    run(*world, 0.5);
    EXPECT_NEAR(angles().first, reference["expected"]["theta1"][0].get<double>(), 0.01);
    EXPECT_NEAR(angles().second, reference["expected"]["theta2"][0].get<double>(), 0.01);
    run(*world, 0.5);
    EXPECT_NEAR(angles().first, reference["expected"]["theta1"][1].get<double>(), 0.03);
    EXPECT_NEAR(angles().second, reference["expected"]["theta2"][1].get<double>(), 0.03);
    run(*world, 9);

    // The energy scale is that of the fall: 3 m g L from the start to the lowest point.
    EXPECT_NEAR(energy(*world), 0, 0.01 * 3 * gravity);
}

TEST(Integration, ConicalPendulumHasItsPeriod) {
    const auto reference = reference_case("conical_pendulum");
    const double period = reference["expected"]["period"];
    const auto world = make_world({.time_step = 1.0 / 240});
    const double angle = 30 * pi / 180, rate = 2 * pi / period;
    const Vec3 start{std::sin(angle), -std::cos(angle), 0};
    const auto bob = add_bob(*world, start, {0, 0, -rate * start.x}, {0, rate, 0});
    ASSERT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = bob, .frame_b = {-start, {}}}));
    double turned = 0;
    for (int i = 0; i < 5 * 240; ++i) {
        const Vec3 before = world->pose(bob).position;
        world->step();
        const Vec3 after = world->pose(bob).position;
        turned += std::atan2(before.z * after.x - before.x * after.z, before.x * after.x + before.z * after.z);
    }
    EXPECT_NEAR(2 * pi * 5 / turned, period, 0.003 * period);
}

TEST(Integration, HeavyTopPrecessesSteadilyAt60Degrees) {
    const auto reference = reference_case("top_60deg");
    const double precession = reference["expected"]["precession"], tilt = 60 * pi / 180;
    const auto world = make_world({.time_step = 1.0 / 1000});

    // Axis of the top in its own frame is Y; the pivot lies 0.1 m below the centre of mass.
    const Quat rotation = from_axis_angle({0, 0, 1}, -tilt);
    const Vec3 axis = rotate(rotation, {0, 1, 0});
    const double spin = 300 - precession * std::cos(tilt);
    const Vec3 omega = axis * spin + Vec3{0, precession, 0};
    const double across = 0.0053125 - 0.5 * 0.1 * 0.1;
    const auto top = world
                         ->create_body({.position = axis * 0.1,
                                        .rotation = rotation,
                                        .linear_velocity = cross(omega, axis * 0.1),
                                        .angular_velocity = omega,
                                        .mass = {.mass = 0.5, .inertia = Mat3::diagonal({across, 0.000625, across})},
                                        .allow_sleep = false})
                         .value();
    ASSERT_TRUE(world->create_joint({.joint = BallJoint{}, .body_b = top, .frame_b = {{0, -0.1, 0}, {}}}));
    double turned = 0, worst_tilt = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 before = world->pose(top).position;
        world->step();
        const Vec3 after = world->pose(top).position;
        turned += std::atan2(before.z * after.x - before.x * after.z, before.x * after.x + before.z * after.z);
        const double now = std::atan2(std::hypot(after.x, after.z), after.y);
        worst_tilt = std::max(worst_tilt, std::fabs(now - tilt));
    }
    EXPECT_NEAR(turned / 2, precession, 0.01 * precession);
    EXPECT_LT(worst_tilt * 180 / pi, 0.5);
}

}  // namespace
}  // namespace embody::physics
