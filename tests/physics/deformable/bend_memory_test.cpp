// SPDX-License-Identifier: MIT
// Sheets that are bent to cylinders and back: the loop of moment and curvature, as on Kawabata's tester.
#include "physics/deformable/cloth/bend_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"

namespace embody::physics::deformable {
namespace {

// A sheet without a World, whose nodes lie on a cylinder about any direction in its plane.
struct BentSheet {
    DeformableDefinition definition = cloth_rectangle(0.4, 0.3, 0.02);
    std::vector<ClothTriangle> triangles = make_cloth_triangles(definition.nodes, std::get<Cloth>(definition.matter));
    BendMemory memory;
    double direction, stiffness = 4;
    std::vector<Vec3> position = definition.nodes;
    TaskPool workers{1};

    BentSheet(double friction, double yield, double bend_direction)
        : memory(make_bend_elements(definition.nodes, std::get<Cloth>(definition.matter)), definition.nodes.size(),
                 friction, yield),
          direction(bend_direction) {}

    double area() const {
        double sum = 0;
        for (const ClothTriangle& triangle : triangles) sum += triangle.area;
        return sum;
    }
    std::vector<Vec3> normals(std::span<const Vec3> nodes) const {
        std::vector<Vec3> all;
        for (const ClothTriangle& t : triangles)
            all.push_back(normalized(cross(nodes[t.node[1]] - nodes[t.node[0]], nodes[t.node[2]] - nodes[t.node[0]])));
        return all;
    }
    double energy() const { return memory.energy(position, normals(position), stiffness); }
    // Bends to a small curvature and returns the work that friction and folds took, per bend stiffness.
    double bend(double curvature) {
        std::vector<Vec3> next = definition.nodes, moves(next.size());
        for (std::size_t i = 0; i < next.size(); ++i) {
            const double along = std::cos(direction) * next[i].x + std::sin(direction) * next[i].z;
            next[i].y = curvature * along * along / 2;
            moves[i] = next[i] - position[i];
        }
        const std::vector<Vec3> before = normals(position), after = normals(next);
        std::vector<std::array<Vec3, 2>> both(before.size());
        for (std::size_t t = 0; t < both.size(); ++t) both[t] = {before[t], after[t]};
        memory.foresee(position, moves, both, stiffness, workers);
        double work = 0;
        for (std::size_t i = 0; i < moves.size(); ++i) work -= dot(memory.force_on(i), moves[i]);
        position = next;
        memory.keep(position, after, stiffness, workers);
        return work;
    }
};

// Work of a loop between -most and most, after one that led into it: of each square metre, per bend stiffness.
double loop_work(BentSheet& sheet, double most, int parts) {
    double work = 0;
    for (int turn = 0; turn < 2; ++turn) {
        work = 0;
        for (int i = 0; i < parts; ++i) work += sheet.bend(most * std::sin(2 * std::numbers::pi * (i + 1) / parts));
    }
    return work / sheet.area();
}

// The same of Dahl's law, in steps so small that any way of solving it is right.
double law_loop_work(double friction, double stiffness, double most) {
    constexpr int parts = 200000;
    double held = 0, work = 0, last = 0;
    for (int turn = 0; turn < 2; ++turn) {
        work = 0;
        for (int i = 0; i < parts; ++i) {
            const double now = most * std::sin(2 * std::numbers::pi * (i + 1) / parts), change = now - last;
            held += stiffness * (change - std::fabs(change) * held / friction);
            work += held * change;
            last = now;
        }
    }
    return work;
}

TEST(BendFriction, ALoopOfBendingTakesTheWorkOfDahlsLawInAnyDirection) {
    Random random(1);
    for (int i = 0; i < 12; ++i) {
        // Small against 1 / 0.4 m, so that a parabola is a cylinder.
        const double friction = 0.02 * random.between(0.2, 1), most = friction * random.between(0.3, 4);
        BentSheet sheet(friction, std::numeric_limits<double>::infinity(), random.between(0, 3.1));
        const double right = law_loop_work(friction, sheet.stiffness, most);
        EXPECT_NEAR(loop_work(sheet, most, 500) / right, 1, 0.08) << "friction " << friction << ", most " << most;
    }
}

TEST(BendFriction, HalfTheHeightOfAWideLoopIsItsFriction) {
    // 2 HB times the way there: Kawabata's 2HB.
    const double friction = 0.002, most = 0.05;
    BentSheet sheet(friction, std::numeric_limits<double>::infinity(), 0.4);
    EXPECT_NEAR(loop_work(sheet, most, 500) / (4 * friction * most), 1, 0.08);
}

TEST(BendFriction, NeverGivesMoreThanItHoldsInStepsOfAnyLength) {
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        const double friction = 0.02 * random.between(0.1, 1), step = friction * random.between(0.02, 4);
        BentSheet sheet(friction, std::numeric_limits<double>::infinity(), random.between(0, 3.1));
        double curvature = 0, energy = sheet.energy();
        for (int k = 0; k < 200; ++k) {
            curvature = std::clamp(curvature + step * random.between(-1, 1), -0.1, 0.1);
            const double work = sheet.bend(curvature), now = sheet.energy();
            EXPECT_GE(work, now - energy - 1e-9 * sheet.area());
            energy = now;
            for (const auto& [xx, yy, xy, a, b, c] : sheet.memory.state())
                ASSERT_LE(std::sqrt(xx * xx + yy * yy + xy * xy), friction * (1 + 1e-12));
        }
    }
}

TEST(BendYield, ALoopBeyondTheLimitTakesTheWorkOfAnElasticPerfectlyPlasticPlate) {
    Random random(3);
    for (int i = 0; i < 6; ++i) {
        const double yield = 0.02 * random.between(0.3, 1), most = yield * random.between(1.2, 3);
        BentSheet sheet(0, yield, random.between(0, 3.1));
        EXPECT_NEAR(loop_work(sheet, most, 500) / (4 * yield * (most - yield)), 1, 0.1) << yield << " " << most;
        BentSheet within(0, yield, random.between(0, 3.1));
        EXPECT_NEAR(loop_work(within, 0.5 * yield, 200), 0, 1e-9);
        EXPECT_TRUE(within.memory.state().empty());
    }
}

}  // namespace
}  // namespace embody::physics::deformable
