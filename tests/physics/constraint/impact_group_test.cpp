// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "foundation/random.h"
#include "physics/constraint/contact/contact.h"
#include "physics/constraint/impact/impact_group.h"

namespace embody::physics::constraint {
namespace {

TEST(FrictionalImpact, SphereNeverChangesItsDirectionOfSliding) {
    // Homogeneous sphere on a plane: A_tn = 0, the control case.
    const Mat3 a = Mat3::diagonal({3.5, 3.5, 1});
    const ImpactOutcome outcome = solve_frictional_impact(a, {3, 4, -1}, {0.1, 0.1, 0.5});
    EXPECT_NEAR(outcome.velocity_after.x / outcome.velocity_after.y, 0.75, 1e-12);
    EXPECT_NEAR(outcome.velocity_after.z, 0.5, 1e-12);
    EXPECT_NEAR(std::hypot(outcome.impulse.x, outcome.impulse.y), 0.1 * outcome.impulse.z, 1e-12);
}

TEST(FrictionalImpact, NeverAddsEnergyAndStaysInTheCone) {
    Random random(3);
    const auto number = [&] { return random.between(-1, 1); };
    for (int i = 0; i < 2000; ++i) {
        // A random positive definite inverse mass.
        const Mat3 root{{number(), number(), number()}, {number(), number(), number()}, {number(), number(), number()}};
        const Mat3 a = root * transpose(root) + Mat3::identity() * 0.05;
        const Vec3 u{number(), number(), -random.between(0.1, 1)};
        const double mu = random.between(0, 1.5), e = random.between(0, 1);
        const ImpactOutcome outcome = solve_frictional_impact(a, u, {mu, mu, e});
        const double change = 0.5 * dot(outcome.impulse, u + outcome.velocity_after);
        ASSERT_LE(change, 1e-9) << i;
        ASSERT_GE(outcome.velocity_after.z, -1e-7) << i;
        ASSERT_LE(std::hypot(outcome.impulse.x, outcome.impulse.y), mu * outcome.impulse.z * (1 + 1e-6) + 1e-12) << i;
    }
}

TEST(ImpactGroup, FlatBoxBouncesWithoutTurning) {
    ImpactGroupMemory memory;
    std::vector<BodyState> bodies(2);
    bodies[1].inverse_mass = 1;
    bodies[1].inverse_inertia = Mat3::identity() * 6;
    bodies[1].linear_velocity = {0, -2, 0};
    std::vector<ImpactSite> sites;
    for (const Vec3 corner : {Vec3{0, -0.5, 0}, Vec3{0.5, -0.5, 0.5}, Vec3{-0.5, -0.5, 0.5}, Vec3{0.5, -0.5, -0.5},
                              Vec3{-0.5, -0.5, -0.5}}) {
        ImpactSite site;
        site.b = 1;
        site.arm_b = corner;
        site.normal = {0, 1, 0};
        site.coefficients = {0.5, 0.5, 0.8};
        sites.push_back(site);
    }
    const ImpactReport report = solve_impact_group(sites, bodies, memory, {});
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(bodies[1].linear_velocity.y, 1.6, 1e-9);
    EXPECT_LT(length(bodies[1].angular_velocity), 1e-9);
    EXPECT_NEAR(report.energy_change, 0.5 * (1.6 * 1.6 - 4), 1e-9);
}

// A site without a bounce on a random body: the impulse that ends in sticking does not depend on the path.
TEST(ImpactGroup, EstimatedSlidesEndAsFollowedOnesAndAddNoEnergy) {
    Random random(11);
    const auto number = [&] { return random.between(-1, 1); };
    int sticking = 0, sliding = 0, rough = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<BodyState> start(2);
        start[1].inverse_mass = random.between(0.5, 2);
        start[1].inverse_inertia = Mat3::diagonal({random.between(3, 8), random.between(3, 8), random.between(3, 8)});
        start[1].linear_velocity = {number(), -random.between(0.5, 2), number()};
        start[1].angular_velocity = {number(), number(), number()};
        const double mu = random.between(0, 1);
        const Vec3 arm{0.5 * number(), -random.between(0.3, 0.6), 0.5 * number()};
        const ImpactSite site{0, 1, {}, arm, {0, 1, 0}, {mu, mu, 0}, {}};
        const double approach = -velocity_at(start[1], arm).y;
        if (approach < 0.1) continue;

        std::vector<BodyState> followed = start, estimated = start;
        ImpactSite followed_site = site, estimated_site = site;
        ImpactGroupMemory memory;
        solve_impact_group({&followed_site, 1}, followed, memory, {});
        const ImpactReport report =
            solve_impact_group({&estimated_site, 1}, estimated, memory, {}, SlidePath::estimated);
        ASSERT_LE(report.energy_change, 1e-12) << i;
        const Vec3 end = velocity_at(followed[1], arm), estimated_end = velocity_at(estimated[1], arm);
        const bool sticks = length(end) < 1e-3 * approach;
        const double error = length(estimated_end - end) / length(velocity_at(start[1], arm));
        ASSERT_LT(error, sticks ? 0.02 : 0.2) << i;
        (sticks ? sticking : sliding) += 1;
        if (error > 0.02) ++rough;
    }
    EXPECT_GT(sticking, 300);
    EXPECT_GT(sliding, 300);
    EXPECT_LT(rough, (sticking + sliding) / 10);
}

TEST(ImpactGroup, ConservesMomentumOfTwoFreeBodies) {
    ImpactGroupMemory memory;
    std::vector<BodyState> bodies(2);
    bodies[0].inverse_mass = 1;
    bodies[0].inverse_inertia = Mat3::identity() * 10;
    bodies[1].inverse_mass = 0.5;
    bodies[1].inverse_inertia = Mat3::identity() * 4;
    bodies[0].linear_velocity = {1, 0.3, 0};
    bodies[1].linear_velocity = {-2, 0, 0.1};
    const Vec3 before = bodies[0].linear_velocity + 2 * bodies[1].linear_velocity;
    ImpactSite site{0, 1, {0.1, 0.05, 0}, {-0.1, 0, 0.02}, {1, 0, 0}, {0.4, 0.4, 0.6}, {}};
    solve_impact_group({&site, 1}, bodies, memory, {});
    EXPECT_LT(length(bodies[0].linear_velocity + 2 * bodies[1].linear_velocity - before), 1e-12);
    EXPECT_GT(dot(site.impulse, site.normal), 0);
}

}  // namespace
}  // namespace embody::physics::constraint
