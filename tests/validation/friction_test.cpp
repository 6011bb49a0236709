// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "validation/reference.h"

namespace embody::physics {
namespace {

// A body of `shape` at rest on the plane tilted by `angle`, its lowest point on it.
BodyHandle put_on_incline(World& world, ShapeHandle shape, double height, double angle, const Material& material,
                          Quat turn = {}) {
    const Vec3 normal{std::sin(angle), std::cos(angle), 0};
    return world
        .create_body({.shape = shape,
                      .position = normal * height,
                      .rotation = from_axis_angle({0, 0, 1}, -angle) * turn,
                      .material = material,
                      .allow_sleep = false})
        .value();
}

Vec3 downhill(double angle) { return {std::cos(angle), -std::sin(angle), 0}; }

TEST(Friction, BlockOnAnInclineHoldsBelowTheThresholdAndSlidesAbove) {
    const auto reference = reference_case("incline_threshold");
    const double threshold = reference["expected"]["theta_c_deg"];
    const auto slide = [&](double degrees, double seconds) {
        const double angle = degrees * pi / 180;
        const auto world = make_world({.time_step = 1.0 / 60});
        add_plane(*world, friction(0.5), angle);
        const auto box = world->create_shape(BoxShape{{0.5, 0.25, 0.5}}).value();
        const auto body = put_on_incline(*world, box, 0.25, angle, friction(0.5));
        const Vec3 start = world->pose(body).position;
        run(*world, seconds);
        return std::pair(dot(world->pose(body).position - start, downhill(angle)),
                         dot(world->linear_velocity(body), downhill(angle)));
    };
    const auto [creep, speed] = slide(threshold - 0.25, 10);
    EXPECT_LT(std::fabs(creep), 0.001);
    EXPECT_LT(std::fabs(speed), 0.001);
    EXPECT_GT(slide(threshold + 0.25, 10).first, 0.1);
    const double acceleration = reference["expected"]["a_at_30deg"];
    EXPECT_NEAR(slide(30, 1).second, acceleration, 0.01 * acceleration);
}

TEST(Friction, SlidingBlockStopsAfterItsSpeedSquaredOverTwoMuG) {
    const auto reference = reference_case("stopping_distance");
    for (std::size_t i = 0; i < 3; ++i) {
        const double mu = reference["setup"]["mu"][i], expected = reference["expected"]["d"][i];
        // Semi-implicit steps brake half a substep early: the error of the distance is v₀ h / 2.
        const auto world = make_world({.time_step = 1.0 / 120});
        add_plane(*world, friction(mu));
        const auto box = world->create_shape(BoxShape{{0.5, 0.1, 0.5}}).value();
        const auto body =
            world
                ->create_body(
                    {.shape = box, .position = {0, 0.1, 0}, .linear_velocity = {2, 0, 0}, .material = friction(mu)})
                .value();
        run(*world, 2);
        EXPECT_NEAR(world->pose(body).position.x, expected, 0.01 * expected) << "mu " << mu;
    }
}

TEST(Friction, SphereRollsDownWithFiveSeventhsOfGSin) {
    const double angle = 30 * pi / 180, expected = reference_case("sphere_roll_incline")["expected"]["a"];
    const auto world = make_world({});
    add_plane(*world, friction(0.5), angle);
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    const auto body = put_on_incline(*world, ball, 0.1, angle, friction(0.5));
    run(*world, 1);
    EXPECT_NEAR(dot(world->linear_velocity(body), downhill(angle)), expected, 0.01 * expected);
}

TEST(Friction, CylinderAndHoopRollDownAtTheirRates) {
    const auto reference = reference_case("cylinder_roll_incline");
    const double angle = 20 * pi / 180;
    const auto roll = [&](std::optional<Mat3> inertia) {
        const auto world = make_world({});
        add_plane(*world, friction(0.6), angle);
        const auto cylinder = world->create_shape(CylinderShape{0.1, 0.1}).value();
        const auto body =
            put_on_incline(*world, cylinder, 0.1, angle, friction(0.6), from_axis_angle({1, 0, 0}, pi / 2));
        if (inertia) {
            BodyDefinition definition = world->body(body).value();
            definition.mass = {.mass = 1, .inertia = inertia};
            EXPECT_TRUE(world->set_body(body, definition));
        }
        run(*world, 1);
        return dot(world->linear_velocity(body), downhill(angle));
    };
    const double cylinder = reference["expected"]["a_cylinder"], hoop = reference["expected"]["a_hoop"];
    EXPECT_NEAR(roll(std::nullopt), cylinder, 0.015 * cylinder);
    EXPECT_NEAR(roll(Mat3::diagonal({0.006, 0.01, 0.006})), hoop, 0.015 * hoop);
}

TEST(Friction, BallWithSideSpinCurvesThenRollsStraight) {
    const auto reference = reference_case("masse_shot");
    const auto& expected = reference["expected"];
    const double radius = 0.03, mu = 0.2;
    const auto world = make_world({.time_step = 1.0 / 240});
    add_plane(*world, friction(mu));
    const auto ball = world->create_shape(SphereShape{radius}).value();

    // The reference is Z up: its (x, y, z) is our (x, z, −y).
    const Vec3 omega = to_vec3(reference["setup"]["omega"]);
    const auto body = world
                          ->create_body({.shape = ball,
                                         .position = {0, radius, 0},
                                         .linear_velocity = {2, 0, 0},
                                         .angular_velocity = {omega.x, omega.z, -omega.y},
                                         .material = friction(mu)})
                          .value();
    const double end = expected["t_slip_end"];
    const double step = world->settings().time_step;
    Vec3 position;
    while (world->last_report().time < end) {
        position = world->pose(body).position;
        world->step();
    }
    const double share = (end - (world->last_report().time - step)) / step;
    position += (world->pose(body).position - position) * share;
    const double way =
        std::hypot(expected["pos_at_slip_end"][0].get<double>(), expected["pos_at_slip_end"][1].get<double>());
    EXPECT_NEAR(position.x, expected["pos_at_slip_end"][0].get<double>(), 0.015 * way);
    EXPECT_NEAR(-position.z, expected["pos_at_slip_end"][1].get<double>(), 0.015 * way);
    run(*world, 0.5);
    const Vec3 v = world->linear_velocity(body);
    EXPECT_NEAR(v.x, expected["v_final"][0].get<double>(), 0.015 * 0.976);
    EXPECT_NEAR(-v.z, expected["v_final"][1].get<double>(), 0.015 * 0.976);
}

TEST(Friction, BallLeavesAFixedSphereAtTheKnownAngle) {
    const auto reference = reference_case("leave_sphere");
    const auto leave = [](double mu) {
        const double big = 1, small = 0.1, reach = big + small;
        // The contact's normal stands still within a step, so a ball parts with up to v² dt / r too much speed: at 1
        // kHz that alone makes a degree, at 4 kHz a quarter of one.
        const auto world = make_world({.time_step = 1.0 / 4000});
        const auto globe = world->create_shape(SphereShape{big}).value();
        const auto ball = world->create_shape(SphereShape{small}).value();
        EXPECT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = globe, .material = friction(mu)}));
        const double start = 0.02;
        const auto body = world
                              ->create_body({.shape = ball,
                                             .position = {reach * std::sin(start), reach * std::cos(start), 0},
                                             .material = friction(mu),
                                             .allow_sleep = false})
                              .value();
        // The gap of a ball that leaves grows as t³, which tells the moment: t = 3 gap / (its rate) ago.
        std::vector<double> angles;
        double last_gap = 0;
        for (int i = 0; i < 4000 * 20; ++i) {
            world->step();
            const Vec3 p = world->pose(body).position;
            const double gap = length(p) - reach;
            angles.push_back(std::atan2(p.x, p.y));
            if (gap > 1e-3) {
                const auto steps_ago = static_cast<std::size_t>(3 * gap / (gap - last_gap));
                return angles.at(angles.size() - 1 - steps_ago) * 180 / pi;
            }
            last_gap = gap;
        }
        ADD_FAILURE() << "the ball never left";
        return 0.0;
    };
    EXPECT_NEAR(leave(2), reference["expected"]["theta_roll_deg"].get<double>(), 1.0);
    EXPECT_NEAR(leave(0), reference["expected"]["theta_slide_deg"].get<double>(), 1.0);
}

TEST(Friction, BallsOnAPushedBoxRollAtTheAnalyticalRates) {
    const auto reference = reference_case("simbench_rolling");
    const auto world = make_world({.time_step = 0.001});
    const auto surface = [](double mu) {
        return Material{.friction_static = mu, .friction_dynamic = mu, .friction_combine = CombineRule::multiply};
    };

    // Coefficients of pairs as products: ground 0.4, box 1, balls 0.8.
    add_plane(*world, surface(0.4));
    const auto box_shape = world->create_shape(BoxShape{{10, 0.5, 10}}).value();
    const auto ball_shape = world->create_shape(SphereShape{0.5}).value();
    const Vec3 direction{75, 0, 129.903810568};
    const auto box = world
                         ->create_body({.shape = box_shape,
                                        .position = {0, 0.5, 0},
                                        .mass = {.mass = 10},
                                        .material = surface(1),
                                        .force = direction})
                         .value();
    std::vector<BodyHandle> balls;
    for (int i = 0; i < 25; ++i) {
        balls.push_back(world
                            ->create_body({.shape = ball_shape,
                                           .position = {2.0 * (i % 5) - 4, 1.5, 2.0 * (i / 5) - 4},
                                           .mass = {.mass = 1},
                                           .material = surface(0.8)})
                            .value());
    }
    // The reference's own formula: a = (F − μ₁(M + nm)g) / (M + 2/7 n m), balls at 2/7 of it.
    const double a_box = (150 - 0.4 * 35 * gravity) / (10 + 25 * 2.0 / 7), a_ball = a_box * 2 / 7;
    EXPECT_NEAR(a_box, reference["expected"]["a_box"].get<double>(), 1e-4);
    EXPECT_NEAR(a_ball, reference["expected"]["a_ball"].get<double>(), 1e-4);
    const Vec3 unit = normalized(direction);
    double sum = 0;
    for (int i = 1; i <= 4000; ++i) {
        world->step();
        const double time = i * 0.001;
        sum += length_squared(world->linear_velocity(box) - unit * (a_box * time)) +
               length_squared(world->linear_velocity(balls[0]) - unit * (a_ball * time));
    }
    RecordProperty("mean_square", std::to_string(sum / 4000));
    EXPECT_LT(sum / 4000, reference["tolerance"]["mean_sq_velocity_error_max"].get<double>());
}

}  // namespace
}  // namespace embody::physics
