// SPDX-License-Identifier: MIT
#include "physics/constraint/direct/contact_newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "foundation/random.h"

namespace embody::physics::constraint {
namespace {

/// Unit cubes one above the other, held by nothing but each other.
struct FloatingColumn {
    explicit FloatingColumn(int count, Random& random) {
        for (int i = 0; i < count; ++i) {
            const double mass = std::exp(random.between(-2, 2));
            bodies.push_back({mass, Mat3::identity() * (mass / 6)});
            free.push_back(make_vec6({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)},
                                     {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}));
        }
        velocity.resize(bodies.size());
        for (int i = 0; i + 1 < count; ++i) {
            DirectPatch patch;
            patch.a = i;
            patch.b = i + 1;
            patch.normal = {0, 1, 0};
            patch.tangent_1 = {1, 0, 0};
            patch.tangent_2 = {0, 0, -1};
            patch.arm_a = {0, 0.5, 0};
            patch.arm_b = {0, -0.5, 0};
            patch.friction_static = patch.friction_dynamic = random.between(0, 1);
            patch.count = 4;
            for (std::size_t k = 0; k < 4; ++k) {
                patch.points[k].s = k & 1 ? 0.5 : -0.5;
                patch.points[k].t = k & 2 ? 0.5 : -0.5;
            }
            begin_substep(patch, {1, 1}, {});
            patches.push_back(patch);
        }
    }

    [[nodiscard]] Vec3 momentum(const std::vector<Vec6>& v) const {
        Vec3 sum;
        for (std::size_t i = 0; i < bodies.size(); ++i) sum += bodies[i].mass * v[i].linear();
        return sum;
    }
    [[nodiscard]] Vec3 angular_momentum(const std::vector<Vec6>& v) const {
        Vec3 sum;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const Vec3 place{0, static_cast<double>(i), 0};
            sum += bodies[i].mass * cross(place, v[i].linear()) + bodies[i].inertia * v[i].angular();
        }
        return sum;
    }
    [[nodiscard]] double energy(const std::vector<Vec6>& v) const {
        double sum = 0;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            sum += bodies[i].mass * length_squared(v[i].linear()) / 2 +
                   dot(v[i].angular(), bodies[i].inertia * v[i].angular()) / 2;
        }
        return sum;
    }

    std::vector<NewtonBody> bodies;
    std::vector<Vec6> free, velocity;
    std::vector<DirectPatch> patches;
};

TEST(ContactNewton, KeepsMomentumAndTheLawsOfContact) {
    Random random(11);
    ContactNewton newton;
    int solved = 0;
    for (int iteration = 0; iteration < 300; ++iteration) {
        FloatingColumn column(2 + iteration % 5, random);
        newton.begin_step({});
        newton.begin(0, column.bodies, column.patches);
        if (!newton.find_velocities(column.free, column.velocity, column.patches)) continue;
        ++solved;
        ASSERT_LT(length(column.momentum(column.velocity) - column.momentum(column.free)), 1e-9) << iteration;
        ASSERT_LT(length(column.angular_momentum(column.velocity) - column.angular_momentum(column.free)), 1e-9);
        ASSERT_LE(column.energy(column.velocity), column.energy(column.free) * (1 + 1e-6)) << iteration;
        for (const DirectPatch& patch : column.patches) {
            const PatchTwist u = relative_twist(patch, column.velocity);
            double load = 0;
            for (const DirectPatch::Point& point : patch.points) {
                const double speed = dot(row_of(point), u.normal_part);
                ASSERT_GE(point.load, 0) << iteration;
                ASSERT_GT(speed, -1e-3) << iteration;
                ASSERT_LT(point.load * speed, 1e-3) << iteration;
                load += point.load;
            }
            const Vec3 f = patch.friction;
            ASSERT_LE(std::hypot(f.x, f.y), patch.friction_dynamic * load * 1.001 + 1e-9) << iteration;
        }
    }
    // Far wilder than what a step meets; the sweeps take the others.
    EXPECT_GT(solved, 100);
}

TEST(ContactNewton, RestKeepsMomentumAndLiesInTheCone) {
    Random random(12);
    ContactNewton newton;
    int solved = 0;
    for (int iteration = 0; iteration < 300; ++iteration) {
        FloatingColumn column(2 + iteration % 5, random);
        newton.begin_step({});
        newton.begin(0, column.bodies, column.patches);
        for (DirectPatch& patch : column.patches) {
            for (DirectPatch::Point& point : patch.points) point.guess = random.between(-1, 1) > 0 ? 0.2 : 0;
            begin_substep(patch, {1, 1}, {});
        }
        if (!newton.find_rest(column.free, column.velocity, column.patches)) continue;
        ++solved;
        ASSERT_LT(length(column.momentum(column.velocity) - column.momentum(column.free)), 1e-9) << iteration;
        ASSERT_LT(length(column.angular_momentum(column.velocity) - column.angular_momentum(column.free)), 1e-9);
        for (const DirectPatch& patch : column.patches) {
            const PatchTwist u = relative_twist(patch, column.velocity);
            double load = 0;
            for (const DirectPatch::Point& point : patch.points) {
                ASSERT_GE(point.load, 0) << iteration;
                ASSERT_GT(dot(row_of(point), u.normal_part), -1e-2) << iteration;
                load += point.load;
            }
            const Vec3 f = patch.friction;
            ASSERT_LE(std::hypot(f.x, f.y), patch.friction_static * load * (1 + 1e-9) + 1e-12) << iteration;
        }
    }
    // Bodies that move at a metre a second are far from rest.
    EXPECT_GT(solved, 150);
}

TEST(ContactNewton, RestOfAColumnUnderItsWeightIsExactAfterAFewSteps) {
    Random random(3);
    FloatingColumn column(10, random);
    DirectPatch ground = column.patches.front();
    ground.a = DirectPatch::immovable;
    ground.b = 0;
    column.patches.push_back(ground);
    std::fill(column.free.begin(), column.free.end(), make_vec6({0, -0.04, 0}, {}));
    ContactNewton newton;
    double worst = 0;
    for (int step = 0; step < 10; ++step) {
        for (DirectPatch& patch : column.patches) begin_substep(patch, {1, 1}, {});
        newton.begin_step({});
        newton.begin(0, column.bodies, column.patches);
        ASSERT_TRUE(newton.find_rest(column.free, column.velocity, column.patches));
        newton.note_rest();
        worst = 0;
        for (const Vec6& v : column.velocity) worst = std::max(worst, length(v.linear()));
        for (DirectPatch& patch : column.patches) end_substep(patch);
    }
    EXPECT_LT(worst, 1e-9);
}

// The impulses of a few sweeps leave of a point's lever arm what rounding makes of zero: friction must not turn into
// spin.
TEST(ContactNewton, SingleLoadedPointHasNoLever) {
    Random random(5);
    FloatingColumn column(2, random);
    DirectPatch& patch = column.patches.front();
    patch.points[0].guess = 1;
    patch.points[1].guess = 1e-9;
    patch.friction_guess = {0.1, 0, 1e-4};
    begin_substep(patch, {1, 1}, {});
    EXPECT_EQ(patch.spin_arm, 0);
}

TEST(ContactNewton, GuessOfTheLastSubstepIsExactTheSecondTime) {
    // Under its own weight on the ground: the loads of the first solve are off by the stiffness, those of the second
    // not.
    Random random(3);
    FloatingColumn column(10, random);
    DirectPatch ground = column.patches.front();
    ground.a = DirectPatch::immovable;
    ground.b = 0;
    column.patches.push_back(ground);
    std::fill(column.free.begin(), column.free.end(), make_vec6({0, -0.04, 0}, {}));
    ContactNewton newton;
    double speed[2] = {};
    for (double& worst : speed) {
        for (DirectPatch& patch : column.patches) begin_substep(patch, {1, 1}, {});
        newton.begin_step({});
        newton.begin(0, column.bodies, column.patches);
        ASSERT_TRUE(newton.find_velocities(column.free, column.velocity, column.patches));
        for (const Vec6& v : column.velocity) worst = std::max(worst, length(v.linear()));
        for (DirectPatch& patch : column.patches) end_substep(patch);
    }
    EXPECT_LT(speed[0], 1e-4);
    EXPECT_LT(speed[1], 1e-8);
}

}  // namespace
}  // namespace embody::physics::constraint
