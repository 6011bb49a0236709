// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "physics/constraint/impact/frictional_impact.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

using namespace constraint;

// The micro-collision of eq. (3) against an independent integration of high order.
class ImpactByEquationThree : public testing::TestWithParam<const char*> {};

TEST_P(ImpactByEquationThree, MatchesTheReference) {
    const auto reference = reference_case(GetParam());
    const auto& expected = reference["expected"];
    const auto& rows = expected["A"];
    const Mat3 a{to_vec3(rows[0]), to_vec3(rows[1]), to_vec3(rows[2])};
    const double mu = reference["setup"]["mu"], e = reference["setup"]["e_stronge"];
    const Vec3 before = to_vec3(expected["u_before"]);
    const ImpactOutcome outcome = solve_frictional_impact(a, before, {mu, mu, e});

    // The reference is printed with 12 digits; the integration is good to six.
    const double speed = length(before), size = length(to_vec3(expected["impulse_contact"]));
    EXPECT_LT(length(outcome.velocity_after - to_vec3(expected["u_after"])), 1e-6 * speed);
    EXPECT_LT(length(outcome.impulse - to_vec3(expected["impulse_contact"])), 1e-6 * size);
    EXPECT_NEAR(outcome.compression_impulse, expected["normal_impulse_at_max_compression"].get<double>(), 1e-6 * size);
    EXPECT_EQ(outcome.sticks, expected["sticks_at_end"].get<bool>());
    const double change = 0.5 * dot(outcome.impulse, before + outcome.velocity_after);
    EXPECT_NEAR(change,
                expected["kinetic_energy_after"].get<double>() - expected["kinetic_energy_before"].get<double>(), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Reference, ImpactByEquationThree,
                         testing::Values("impact_box_swerve", "impact_box_stick", "impact_eccentric_sphere",
                                         "impact_rod_kane", "impact_rod_jam"));

TEST(Impact, BoxCornerSwervesThroughTheWholeStep) {
    const auto reference = reference_case("impact_box_swerve");
    const auto world = make_world({.gravity = {}, .time_step = 0.001});
    add_plane(*world, {.friction_static = 0.1, .friction_dynamic = 0.1, .restitution = 0.8});

    // The reference has its normal along Z; here it is Y: (x, y, z) becomes (x, z, −y), a turn of −90° about X.
    const Quat turn = from_axis_angle({1, 0, 0}, -pi / 2);
    const auto to_y_up = [&](Vec3 v) { return rotate(turn, v); };
    const auto box = world->create_shape(BoxShape{{0.1, 0.2, 0.3}}).value();
    const Quat rotation = normalized(turn * normalized(Quat{0.3, 0.25, 0.35, 0.85}));
    const Vec3 corner = to_y_up(to_vec3(reference["setup"]["contact_r"]));
    const Vec3 velocity = to_y_up(to_vec3(reference["setup"]["v"]));
    const double gap = 0.0013;
    const auto body =
        world
            ->create_body({.shape = box,
                           .position = {0, -corner.y + gap, 0},
                           .rotation = rotation,
                           .linear_velocity = velocity,
                           .mass = {.mass = 1},
                           .material = {.friction_static = 0.1, .friction_dynamic = 0.1, .restitution = 0.8}})
            .value();
    for (int i = 0; i < 2; ++i) world->step();
    const double tolerance = reference["tolerance"]["velocity_abs"];
    EXPECT_LT(length(world->linear_velocity(body) - to_y_up(to_vec3(reference["expected"]["v1_after"]))), tolerance);
    EXPECT_LT(length(world->angular_velocity(body) - to_y_up(to_vec3(reference["expected"]["omega1_after"]))), 0.02);
}

// Feet of one body that come down micrometres apart come down together: what they touch gives way for longer than that.
// Each on its own would take the little rebound of the others away.
class TableThatLands : public testing::TestWithParam<double> {};

TEST_P(TableThatLands, BouncesOnAllItsFeet) {
    const double restitution = GetParam();
    const auto world = make_world({.time_step = 1.0 / 60});
    const Material material{.friction_static = 0.5, .friction_dynamic = 0.4, .restitution = restitution};
    add_plane(*world, material);
    CompoundShape table;
    table.children.push_back({BoxShape{{0.6, 0.02, 0.4}}, {{0, 0.72, 0}, {}}});
    const double uneven[] = {0, 12e-6, 25e-6, 7e-6};
    for (int i = 0; i < 4; ++i) {
        const Vec3 foot{i & 1 ? 0.55 : -0.55, 0.35 + uneven[i], i & 2 ? 0.35 : -0.35};
        table.children.push_back({BoxShape{{0.03, 0.35, 0.03}}, {foot, {}}});
    }
    const auto shape = world->create_shape(table).value();
    const double height = 0.1;
    const auto body = world->create_body({.shape = shape, .position = {0, height, 0}, .material = material}).value();

    // It falls, meets the ground, and rises to e² of the height.
    double top = 0;
    bool has_bounced = false;
    for (int i = 0; i < 60; ++i) {
        world->step();
        has_bounced = has_bounced || world->linear_velocity(body).y > 0;
        if (has_bounced) top = std::max(top, world->pose(body).position.y);
        if (has_bounced && world->linear_velocity(body).y < 0) break;
    }
    EXPECT_NEAR(std::sqrt(top / height), restitution, 0.03);
    EXPECT_LT(length(world->angular_velocity(body)), 0.15);
}

INSTANTIATE_TEST_SUITE_P(Restitutions, TableThatLands, testing::Values(0.15, 0.3, 0.5, 0.8));

}  // namespace
}  // namespace embody::physics
