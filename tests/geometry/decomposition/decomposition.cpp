// SPDX-License-Identifier: MIT
#include "geometry/decomposition/decomposition.h"

#include <gtest/gtest.h>

#include <limits>

#include "foundation/random.h"
#include "geometry/decomposition/measure_decomposition.h"
#include "geometry/furniture_meshes.h"

namespace embody::geometry {
namespace {

constexpr double error = 0.01;  // m, the standard of hull_error

Decomposition decomposed(const TriangleMesh& mesh, const DecompositionParameters& parameters = {}) {
    auto made = decompose(mesh, parameters);
    EXPECT_TRUE(made.ok()) << made.error().message();
    return made.ok() ? *std::move(made) : Decomposition{};
}

bool any_contains(const Decomposition& parts, Vec3 p, double margin = 0) {
    for (const ConvexHull& hull : parts.hulls) {
        bool inside = true;
        for (const auto& face : hull.faces) inside = inside && dot(face.normal, p) <= face.offset + margin;
        if (inside) return true;
    }
    return false;
}

// Checks what holds for every decomposition of any mesh.
void expect_sound(const TriangleMesh& mesh, const DecompositionParameters& parameters = {}) {
    const Decomposition parts = decomposed(mesh, parameters);
    ASSERT_FALSE(parts.hulls.empty());
    EXPECT_LE(parts.hulls.size(), static_cast<std::size_t>(parameters.max_hulls));
    ASSERT_EQ(parts.depths.size(), parts.hulls.size());
    double margin = parameters.hull_error;
    for (const double depth : parts.depths) EXPECT_LE(depth, parts.concavity);
    for (const ConvexHull& hull : parts.hulls) {
        EXPECT_LE(hull.vertices.size(), static_cast<std::size_t>(parameters.max_vertices));
        EXPECT_GT(integrate_hull(hull).volume, 0);
        margin = std::max(margin, parameters.hull_error + hull.left_outside);
    }
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t corner : t) {
            EXPECT_TRUE(any_contains(parts, to_vec3(mesh.positions[corner]), margin));
        }
    }
}

TEST(Decomposition, RefusesWhatIsNoMeshOrNoParameter) {
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_FALSE(decompose({}).ok());
    EXPECT_FALSE(decompose({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 7}}}).ok());
    TriangleMesh broken = box;
    broken.positions[0].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(decompose(broken).ok());
    EXPECT_FALSE(decompose({{{0, 0, 0}, {1, 1, 1}}, {{0, 1, 1}}}).ok());
    EXPECT_FALSE(decompose(make_box({1e6, 1, 1})).ok());
    EXPECT_EQ(decompose(box, {.max_hulls = 0}).error().where, "convex decomposition: max_hulls");
    EXPECT_FALSE(decompose(box, {.max_hulls = 257}).ok());
    EXPECT_EQ(decompose(box, {.hull_error = 0}).error().where, "convex decomposition: hull_error");
    EXPECT_FALSE(decompose(box, {.hull_error = std::numeric_limits<double>::quiet_NaN()}).ok());
    EXPECT_FALSE(decompose(box, {.max_vertices = 3}).ok());
    EXPECT_FALSE(decompose(box, {.cells = 1}).ok());
}

TEST(Decomposition, AConvexThingIsOneHull) {
    for (const TriangleMesh& mesh : {make_box({0.3, 0.2, 0.1}), make_sphere(0.4), make_cylinder(0.2, 0.5),
                                     moved(make_box({0.5, 0.1, 0.2}), {{1, 2, 3}, normalized(Quat{1, 2, 3, 4})})}) {
        const Decomposition parts = decomposed(mesh);
        EXPECT_EQ(parts.hulls.size(), 1u);
        EXPECT_LE(parts.concavity, error);
        EXPECT_EQ(parts.hull_concavity, parts.concavity);
    }
}

TEST(Decomposition, AnAngleIsTwoHulls) {
    for (const Quat turn : {Quat{}, Quat{0, 0, 1, 0}, normalized(Quat{1, 2, 3, 4})}) {
        const Decomposition parts = decomposed(moved(make_angle(), {{}, turn}));
        EXPECT_EQ(parts.hulls.size(), 2u);
        // The middle of the chord from (1, 0.2) to (0.2, 1) lies 0.4 from both bars.
        EXPECT_NEAR(parts.hull_concavity, 0.4, 0.02);
    }
    const Decomposition parts = decomposed(make_angle());
    double volume = 0;
    for (const ConvexHull& hull : parts.hulls) volume += integrate_hull(hull).volume;
    EXPECT_NEAR(volume, 0.2 * (0.2 + 0.8 * 0.2), 0.002);
}

TEST(Decomposition, PartsThatAreConnectedAreHullsAsTheyAre) {
    EXPECT_EQ(decomposed(make_chair()).hulls.size(), 6u);
    const Decomposition table = decomposed(make_table());
    ASSERT_EQ(table.hulls.size(), 5u);
    EXPECT_NEAR(integrate_hull(table.hulls[0]).volume, 1.4 * 0.04 * 0.8, 1e-6);
    EXPECT_EQ(table.concavity, 0);
}

TEST(Decomposition, AMugIsHollowWithAndWithoutThickness) {
    for (const TriangleMesh& mesh : {make_mug(), make_open_mug(), make_soup(make_open_mug())}) {
        const Decomposition parts = decomposed(mesh);
        EXPECT_LE(parts.hulls.size(), 8u);
        EXPECT_GT(parts.hull_concavity, 0.03);
        EXPECT_LE(parts.concavity, error);
        for (const double y : {0.02, 0.05, 0.099}) EXPECT_FALSE(any_contains(parts, {0, y, 0}));
        EXPECT_FALSE(any_contains(parts, {0.02, 0.05, 0.01}));
        EXPECT_TRUE(any_contains(parts, {0.0375, 0.05, 0}, error));
    }
}

TEST(Decomposition, WhatIsOpenOnlyBelowIsFilledUnlessAskedOtherwise) {
    const TriangleMesh lid = moved(make_open_mug(), {{0, 0.1, 0}, {1, 0, 0, 0}});
    EXPECT_EQ(decomposed(lid).hulls.size(), 1u);
    const Decomposition hollow = decomposed(lid, {.open_below = true});
    EXPECT_GT(hollow.hulls.size(), 4u);
    EXPECT_FALSE(any_contains(hollow, {0, 0.05, 0}));
}

TEST(Decomposition, ATorusKeepsItsHoleHoweverItLies) {
    for (const Quat turn : {Quat{}, normalized(Quat{1, 0, 0, 1}), normalized(Quat{0.3, 0.2, 0.1, 0.9})}) {
        const TriangleMesh torus = moved(make_torus(0.3, 0.1), {{}, turn});
        const Decomposition parts = decomposed(torus, {.max_hulls = 32, .hull_error = 0.03});
        EXPECT_LE(parts.concavity, 0.03);
        EXPECT_LE(parts.hulls.size(), 16u);
        EXPECT_FALSE(any_contains(parts, {0, 0, 0}));
        EXPECT_FALSE(any_contains(parts, rotate(turn, {0.1, 0, 0})));
        EXPECT_TRUE(any_contains(parts, rotate(turn, {0.3, 0, 0})));
    }
}

TEST(Decomposition, SheetsAndSingleTrianglesGetAThickness) {
    TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}};
    const Decomposition one = decomposed(triangle);
    ASSERT_EQ(one.hulls.size(), 1u);
    EXPECT_NEAR(integrate_hull(one.hulls[0]).volume, 0.5 * 2e-3, 1e-5);

    // A flat frame around a hole.
    TriangleMesh frame;
    append(frame, make_box({1, 0, 0.1}, {0, 0, 0.9}));
    append(frame, make_box({1, 0, 0.1}, {0, 0, -0.9}));
    append(frame, make_box({0.1, 0, 0.8}, {0.9, 0, 0}));
    append(frame, make_box({0.1, 0, 0.8}, {-0.9, 0, 0}));
    const Decomposition sides = decomposed(frame);
    EXPECT_EQ(sides.hulls.size(), 4u);
    EXPECT_FALSE(any_contains(sides, {0, 0, 0}, 0.01));
}

TEST(Decomposition, RealMeshesDefectsDoNotMatter) {
    // The same triangles twice, reversed triangles, separate vertices, parts that intersect each other.
    TriangleMesh chair = make_chair();
    append(chair, make_chair());
    for (std::size_t i = 0; i < chair.triangles.size(); i += 3) {
        std::swap(chair.triangles[i][0], chair.triangles[i][1]);
    }
    append(chair, make_box({0.15, 0.05, 0.15}, {0, 0.44, 0}));
    const Decomposition parts = decomposed(make_soup(chair));
    EXPECT_LE(parts.hulls.size(), 8u);
    EXPECT_LE(parts.concavity, error);
    EXPECT_FALSE(any_contains(parts, {0, 0.2, 0}));
}

TEST(Decomposition, EveryMeshIsCoveredWithinTheBudget) {
    expect_sound(make_chair());
    expect_sound(make_mug());
    expect_sound(make_open_mug(), {.max_hulls = 3});
    expect_sound(make_torus(0.3, 0.1), {.max_hulls = 4});
    expect_sound(make_torus(0.3, 0.1, 300, 150), {.max_hulls = 256, .hull_error = 0.02});
    expect_sound(make_table(), {.max_hulls = 1});
    expect_sound(make_table(), {.max_hulls = 2, .max_vertices = 8});
    Random random(7);
    for (int round = 0; round < 20; ++round) {
        TriangleMesh soup;
        const std::uint64_t count = 1 + random.below(60);
        for (std::uint32_t i = 0; i < count; ++i) {
            for (int k = 0; k < 3; ++k) {
                soup.positions.push_back(
                    to_vec3f({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}));
            }
            soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        expect_sound(soup, {.max_hulls = 1 + static_cast<int>(random.below(12)), .hull_error = 0.05});
    }
}

TEST(Decomposition, ManySmallPartsAndManyTrianglesStayWithinBounds) {
    // A hedge of 2,000 separate leaves, and a sphere of half a million triangles.
    Random random(11);
    TriangleMesh leaves;
    for (int i = 0; i < 2000; ++i) {
        append(leaves,
               make_box({0.02, 0.001, 0.01}, {random.between(-1, 1), random.between(0, 1), random.between(-0.2, 0.2)}));
    }
    EXPECT_LE(decomposed(leaves).hulls.size(), 16u);
    expect_sound(make_sphere(0.5, 1000, 250));
}

TEST(Decomposition, TheSameMeshGivesTheSameHulls) {
    for (const TriangleMesh& mesh : {make_mug(), make_torus(0.3, 0.1)}) {
        const Decomposition a = decomposed(mesh), b = decomposed(mesh);
        ASSERT_EQ(a.hulls.size(), b.hulls.size());
        for (std::size_t i = 0; i < a.hulls.size(); ++i) EXPECT_EQ(a.hulls[i].vertices, b.hulls[i].vertices);
        EXPECT_EQ(a.concavity, b.concavity);
    }
}

TEST(Decomposition, MoreHullsAreNoWorse) {
    double before = std::numeric_limits<double>::infinity();
    for (const int hulls : {1, 4, 8, 16, 32}) {
        const Decomposition parts = decomposed(make_torus(0.3, 0.1), {.max_hulls = hulls});
        EXPECT_LE(parts.concavity, before * 1.1);
        before = parts.concavity;
    }
    EXPECT_LE(before, 0.03);
}

TEST(Decomposition, CanBeStopped) {
    double last = -1;
    int calls = 0;
    const auto stop_late = [&](double share) {
        EXPECT_GE(share, last);
        EXPECT_LE(share, 1);
        last = share;
        return ++calls < 3;
    };
    EXPECT_FALSE(decompose(make_torus(0.3, 0.1), {.progress = stop_late}).ok());
    EXPECT_EQ(calls, 3);
}

TEST(Decomposition, AHullWhoseHollowsDoNotCountIsKept) {
    EXPECT_EQ(decomposed(make_chair(), {.keep_below = 1}).hulls.size(), 1u);
    EXPECT_EQ(decomposed(make_chair(), {.keep_below = 0.02}).hulls.size(), 6u);
}

TEST(MeasureDecomposition, KnowsWhatHullsAddAndLeaveOut) {
    const TriangleMesh angle = make_angle();
    const auto whole = build_convex_hull(angle);
    ASSERT_TRUE(whole);
    const DecompositionMeasure one = measure_decomposition(angle, std::span(&*whole, 1));
    // The middle of the chord from (1, 0.2) to (0.2, 1) lies 0.4 from both bars.
    EXPECT_NEAR(one.added, 0.4, 0.02);
    EXPECT_LT(one.left_out, 1e-6);
    const Decomposition two = decomposed(angle);
    const DecompositionMeasure best = measure_decomposition(angle, two.hulls);
    EXPECT_LT(best.added, 2e-3);
    EXPECT_LT(best.left_out, 1e-6);
    const DecompositionMeasure half = measure_decomposition(angle, std::span(two.hulls).first(1));
    EXPECT_NEAR(half.left_out, 0.8, 0.02);
}

}  // namespace
}  // namespace embody::geometry
