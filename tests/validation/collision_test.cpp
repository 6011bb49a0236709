// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

Material bouncing(double e, double mu = 0) { return {.friction_static = mu, .friction_dynamic = mu, .restitution = e}; }

TEST(Collision, BounceHeightsFallByTheSquareOfRestitution) {
    const auto reference = reference_case("bounce_heights");
    const double radius = 0.05;
    const auto world = make_world({.time_step = 1.0 / 240});
    add_plane(*world, bouncing(0.8));
    const auto ball = world->create_shape(SphereShape{radius}).value();
    const auto body =
        world->create_body({.shape = ball, .position = {0, 1 + radius, 0}, .material = bouncing(0.8)}).value();

    // Heights of the vertices from energy, time of rest from the last upward motion.
    std::vector<double> heights;
    double time_to_rest = 0, last_speed = 0;
    for (int i = 0; i < 6 * 240; ++i) {
        world->step();
        const double v = world->linear_velocity(body).y, h = world->pose(body).position.y - radius;
        if (last_speed < -0.1 && v > 0.1) heights.push_back(h + v * v / (2 * gravity));
        if (std::fabs(v) > 1e-3 || h > 1e-3) time_to_rest = world->last_report().time;
        last_speed = v;
    }
    ASSERT_GE(heights.size(), 3u);
    const char* names[] = {"h1", "h2", "h3"};
    for (std::size_t i = 0; i < 3; ++i) {
        const double expected = reference["expected"][names[i]];
        EXPECT_NEAR(heights[i], expected, 0.01 * expected);
    }
    const double expected = reference["expected"]["time_to_rest"];
    EXPECT_NEAR(time_to_rest, expected, 0.02 * expected);
}

TEST(Collision, FortyNineElasticBallsKeepTheirEnergyFor20Seconds) {
    const auto reference = reference_case("simbench_bouncing");
    const auto world = make_world({.time_step = 0.01});
    add_plane(*world, bouncing(1));
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    for (int i = 0; i < 49; ++i) {
        ASSERT_TRUE(world->create_body({.shape = ball,
                                        .position = {0.5 * (i % 7), 5, 0.5 * (i / 7)},
                                        .mass = {.mass = 10},
                                        .material = bouncing(1)}));
    }
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
        world->step();
        const double error = energy(*world) - reference["expected"]["E0"].get<double>();
        sum += error * error;
    }
    EXPECT_LT(sum / 2000, reference["tolerance"]["mean_sq_error_max"].get<double>());
}

TEST(Collision, TwoSpheresOnALineExchangeMomentum) {
    const auto reference = reference_case("elastic_1d");
    const auto world = make_world({.gravity = {}});
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    const auto a = world
                       ->create_body({.shape = ball,
                                      .position = {-1, 0, 0},
                                      .linear_velocity = {3, 0, 0},
                                      .mass = {.mass = 1},
                                      .material = bouncing(0.6)})
                       .value();
    const auto b = world
                       ->create_body({.shape = ball,
                                      .position = {1, 0, 0},
                                      .linear_velocity = {-4, 0, 0},
                                      .mass = {.mass = 2},
                                      .material = bouncing(0.6)})
                       .value();
    run(*world, 0.5);
    EXPECT_NEAR(world->linear_velocity(a).x, reference["expected"]["v1"].get<double>(), 1e-4);
    EXPECT_NEAR(world->linear_velocity(b).x, reference["expected"]["v2"].get<double>(), 1e-4);
}

TEST(Collision, CradleWithGapsPassesTheBlowOn) {
    const auto reference = reference_case("cradle_gap");
    const auto world = make_world({.gravity = {}, .sleeping = false});
    const auto ball = world->create_shape(SphereShape{0.05}).value();
    std::vector<BodyHandle> balls;
    for (int i = 0; i < 5; ++i) {
        balls.push_back(world
                            ->create_body({.shape = ball,
                                           .position = {i * 0.101, 0, 0},
                                           .linear_velocity = {i == 0 ? 1.0 : 0.0, 0, 0},
                                           .material = bouncing(0.9)})
                            .value());
    }
    run(*world, 0.1);
    const double expected = reference["expected"]["v_last"];
    EXPECT_NEAR(world->linear_velocity(balls[4]).x, expected, 0.005 * expected);
}

TEST(Collision, ObliqueSphereSticksAndTakesTwoSeventhsOfItsSlip) {
    const auto reference = reference_case("oblique_sphere_stick");
    const auto world = make_world({.gravity = {}});
    add_plane(*world, bouncing(0.6, 0.5));
    const auto ball = world->create_shape(SphereShape{0.1}).value();

    // The reference's normal is Z, ours Y: its (x, y, z) is our (x, z, −y).
    const auto body = world
                          ->create_body({.shape = ball,
                                         .position = {0, 0.2, 0},
                                         .linear_velocity = {3, -2, 0},
                                         .mass = {.mass = 1},
                                         .material = bouncing(0.6, 0.5)})
                          .value();
    run(*world, 0.2);
    const Vec3 v = to_vec3(reference["expected"]["v"]), w = to_vec3(reference["expected"]["omega"]);
    EXPECT_LT(length(world->linear_velocity(body) - Vec3{v.x, v.z, -v.y}), 1e-4);
    EXPECT_LT(length(world->angular_velocity(body) - Vec3{w.x, w.z, -w.y}), 1e-3);
    EXPECT_NEAR(world->conserved().kinetic_energy, reference["expected"]["energy_after"].get<double>(), 1e-4);
}

TEST(Collision, TwoSpheresMeetObliquelyWithFriction) {
    const auto reference = reference_case("two_spheres_oblique");
    const auto& expected = reference["expected"];
    const auto world = make_world({.gravity = {}});
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    const Vec3 v1 = to_vec3(reference["setup"]["v1"]), v2 = to_vec3(reference["setup"]["v2"]);

    // Placed so that after 21 ms sphere 2 lies on the +X side of sphere 1, as the normal says.
    const double time = 0.021;
    const auto make = [&](Vec3 place, Vec3 velocity) {
        return world
            ->create_body({.shape = ball,
                           .position = place - velocity * time,
                           .linear_velocity = velocity,
                           .mass = {.mass = 1},
                           .material = bouncing(0.8, 0.2)})
            .value();
    };
    const auto first = make({0, 0, 0}, v1), second = make({0.2, 0, 0}, v2);
    run(*world, 0.1);
    EXPECT_LT(length(world->linear_velocity(first) - to_vec3(expected["v1"])), 1e-4);
    EXPECT_LT(length(world->linear_velocity(second) - to_vec3(expected["v2"])), 1e-4);
    EXPECT_LT(length(world->angular_velocity(first) - to_vec3(expected["w1"])), 1e-3);
    EXPECT_LT(length(world->angular_velocity(second) - to_vec3(expected["w2"])), 1e-3);
    EXPECT_NEAR(world->conserved().kinetic_energy, expected["energy_after"].get<double>(), 1e-4);
}

TEST(Collision, ElasticSixBySixBySixKeepsItsEnergy) {
    const auto reference = reference_case("elastic666");
    const auto world = make_world({.time_step = 0.001});
    add_plane(*world, bouncing(1));
    const auto ball = world->create_shape(SphereShape{0.1}).value();
    Random random(666);
    for (int i = 0; i < 216; ++i) {
        const Vec3 place{0.21 * (i % 6), 1.101 + 0.21 * (i / 36), 0.21 * (i / 6 % 6)};
        const Vec3 noise{random.between(0, 1e-3), random.between(0, 1e-3), random.between(0, 1e-3)};
        ASSERT_TRUE(world->create_body(
            {.shape = ball, .position = place + noise, .mass = {.mass = 10}, .material = bouncing(1)}));
    }
    const double start = energy(*world);
    double sum = 0;
    for (int i = 0; i < 10000; ++i) {
        world->step();
        const double error = energy(*world) - start;
        sum += error * error;
    }
    RecordProperty("mean_square", std::to_string(sum / 10000));
    EXPECT_LT(sum / 10000, reference["tolerance"]["max"].get<double>());
}

}  // namespace
}  // namespace embody::physics
