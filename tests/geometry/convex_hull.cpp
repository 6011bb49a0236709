// SPDX-License-Identifier: MIT
#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <thread>

#include "foundation/random.h"
#include "foundation/state_hash.h"
#include "geometry/sample_meshes.h"

namespace embody::geometry {
namespace {

Vec3 random_direction(Random& random) {
    const double z = random.between(-1, 1), angle = random.between(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}
std::vector<Vec3> points_of(const TriangleMesh& mesh) {
    std::vector<Vec3> points;
    for (const Vec3f p : mesh.positions) points.push_back(to_vec3(p));
    return points;
}

// Checks all that the header promises for any hull.
void expect_sound(const ConvexHull& hull, std::span<const Vec3> points) {
    const Vec3 extent = bounds(hull).size();
    const double size = std::max({extent.x, extent.y, extent.z});
    EXPECT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
    EXPECT_LE(hull.planarity, 1e-5 * size);
    const double slack = std::max(1e-5 * size, 1.01 * hull.left_outside);
    double worst_vertex = 0, worst_point = 0, worst_corner = 0, shortest_normal = 1;
    for (std::uint32_t f = 0; f < hull.faces.size(); ++f) {
        const auto& face = hull.faces[f];
        ASSERT_GE(face.count, 3u);
        shortest_normal = std::min(shortest_normal, length(face.normal));
        for (const Vec3 v : hull.vertices) worst_vertex = std::max(worst_vertex, dot(face.normal, v) - face.offset);
        for (const Vec3 p : points) worst_point = std::max(worst_point, dot(face.normal, p) - face.offset);
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const std::uint32_t a = hull.face_vertices[face.first + i];
            const std::uint32_t b = hull.face_vertices[face.first + (i + 1) % face.count];
            worst_corner = std::max(worst_corner, face.offset - dot(face.normal, hull.vertices[a]));
            const auto& edge = hull.edges[hull.face_edges[face.first + i]];
            EXPECT_TRUE((edge.start == a && edge.end == b && edge.left == f) ||
                        (edge.start == b && edge.end == a && edge.right == f));
        }
    }
    EXPECT_LE(worst_vertex, 1e-9 * size);
    EXPECT_LE(worst_corner, 1e-5 * size);
    EXPECT_LE(worst_point, slack);
    EXPECT_NEAR(shortest_normal, 1, 1e-12);
    for (const auto& edge : hull.edges) EXPECT_NE(edge.left, edge.right);
}

std::string reason(std::span<const Vec3> points, int max_vertices = 256) {
    const auto hull = build_convex_hull(points, max_vertices);
    return hull.ok() ? "" : hull.error().message();
}

TEST(ConvexHullErrors, NameTheReason) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const std::vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_NE(reason({}).find("at least 4 points"), std::string::npos);
    EXPECT_NE(reason(std::vector<Vec3>(3)).find("at least 4 points"), std::string::npos);
    EXPECT_NE(reason(std::vector<Vec3>(9, Vec3{1, 2, 3})).find("same point"), std::string::npos);
    EXPECT_NE(reason(std::vector<Vec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}).find("one line"),
              std::string::npos);
    EXPECT_NE(reason(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 1e-7, 1}}).find("one plane"),
              std::string::npos);
    EXPECT_NE(reason(corner, 3).find("max_vertices"), std::string::npos);
    EXPECT_NE(reason(corner, 1 << 20).find("max_vertices"), std::string::npos);
    for (const double bad : {nan, inf, -inf}) {
        std::vector<Vec3> points = corner;
        points[2].z = bad;
        EXPECT_NE(reason(points).find("point 2 is not finite"), std::string::npos);
    }
    std::vector<Vec3> far = corner;
    for (Vec3& p : far) p *= 1e200;
    EXPECT_NE(reason(far).find("too far apart"), std::string::npos);
    EXPECT_FALSE(build_convex_hull(TriangleMesh{}).ok());
}

TEST(ConvexHull, BoxHasSixQuadsAndTwelveEdges) {
    const auto hull = build_convex_hull(make_soup(make_box({1, 2, 3}, {7, 0, 0})));
    ASSERT_TRUE(hull.ok());
    EXPECT_EQ(hull->vertices.size(), 8u);
    EXPECT_EQ(hull->faces.size(), 6u);
    EXPECT_EQ(hull->edges.size(), 12u);
    for (const auto& face : hull->faces) EXPECT_EQ(face.count, 4u);
    const MassProperties p = integrate_hull(*hull);
    EXPECT_NEAR(p.volume, 48, 1e-12);
    EXPECT_LE(distance(p.center, {7, 0, 0}), 1e-14);
    EXPECT_NEAR(integrate_polyhedron(to_mesh(*hull)).volume, 48, 1e-12);
}

TEST(ConvexHull, RotatedBoxInSinglePrecisionStillHasSixFaces) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Transform t{random_direction(random) * 3.0,
                          from_axis_angle(random_direction(random), random.between(0, 6))};
        const TriangleMesh box = moved(make_box({0.2, 0.5, 1}), t);
        const auto hull = build_convex_hull(box);
        ASSERT_TRUE(hull.ok());
        EXPECT_EQ(hull->faces.size(), 6u);
        expect_sound(*hull, points_of(box));
    }
}

TEST(ConvexHull, PointsInsideOnFacesAndOnEdgesAreDropped) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) {
            for (int k = 0; k <= 8; ++k) points.push_back({i * 0.1, j * 0.1, k * 0.1});
        }
    }
    const auto hull = build_convex_hull(points, 8);
    ASSERT_TRUE(hull.ok());
    EXPECT_EQ(hull->vertices.size(), 8u);
    EXPECT_EQ(hull->faces.size(), 6u);
    expect_sound(*hull, points);
}

TEST(ConvexHull, IsTheSameShapeFromMillimetresToTenKilometres) {
    const std::vector<Vec3> unit = points_of(make_cylinder(1, 2, 24));
    for (const double size : {1e-3, 1.0, 1e4}) {
        std::vector<Vec3> points;
        for (const Vec3 p : unit) points.push_back(p * size);
        const auto hull = build_convex_hull(points);
        ASSERT_TRUE(hull.ok());
        EXPECT_EQ(hull->faces.size(), 26u);
        EXPECT_EQ(hull->edges.size(), 72u);
        expect_sound(*hull, points);
        EXPECT_NEAR(integrate_hull(*hull).volume / (size * size * size), 4 * 12 * std::sin(pi / 12), 1e-5);
    }
}

TEST(ConvexHull, CloudsOfAllKindsAreSound) {
    Random random(11);
    for (int round = 0; round < 300; ++round) {
        const auto count = 4 + random.below(400);
        const double flat = std::pow(10.0, random.between(-3.5, 0));
        const double grid = std::pow(2.0, double(random.below(12)));
        const bool on_sphere = random.below(2) == 0, snapped = random.below(2) == 0;
        std::vector<Vec3> points;
        for (std::uint64_t i = 0; i < count; ++i) {
            Vec3 p = random_direction(random) * (on_sphere ? 1.0 : random.unit());
            p.y *= flat;
            if (snapped)
                p = {std::round(p.x * grid) / grid, std::round(p.y * grid) / grid, std::round(p.z * grid) / grid};
            points.push_back(to_vec3(to_vec3f(p)));
        }
        const auto hull = build_convex_hull(points, 64);
        if (!hull.ok()) {
            EXPECT_NE(hull.error().why.find("all points"), std::string::npos) << hull.error().message();
            continue;
        }
        EXPECT_LE(hull->vertices.size(), 64u);
        expect_sound(*hull, points);
    }
}

TEST(ConvexHull, ReducedSphereKeepsMostOfItsVolume) {
    const TriangleMesh sphere = make_sphere(1, 200, 100);
    double last_outside = 1;
    for (const int limit : {16, 64, 256}) {
        const auto hull = build_convex_hull(sphere, limit);
        ASSERT_TRUE(hull.ok());
        EXPECT_LE(hull->vertices.size(), std::size_t(limit));
        EXPECT_LT(hull->left_outside, last_outside);
        last_outside = hull->left_outside;
        expect_sound(*hull, points_of(sphere));
    }
    EXPECT_LT(last_outside, 0.025);
    EXPECT_GT(integrate_hull(*build_convex_hull(sphere, 256)).volume, 0.96 * 4 / 3 * pi);
}

TEST(ConvexHull, ReductionKeepsASpike) {
    TriangleMesh mesh = make_sphere(1, 64, 32);
    mesh.positions[700] = {5, 5, 5};
    const auto hull = build_convex_hull(mesh, 12);
    ASSERT_TRUE(hull.ok());
    EXPECT_LE(distance(bounds(*hull).upper, {5, 5, 5}), 1e-12);
}

std::uint64_t hash_of(const ConvexHull& hull) {
    StateHash hash;
    for (const Vec3 v : hull.vertices) {
        for (int k = 0; k < 3; ++k) hash.add(v[k]);
    }
    for (const std::uint32_t i : hull.face_vertices) hash.add(std::uint64_t{i});
    return hash.value();
}

TEST(ConvexHull, IsTheSameBitForBitFromFourThreads) {
    const TriangleMesh sphere = make_sphere(1, 60, 30);
    std::vector<std::uint64_t> hashes(4);
    std::vector<std::thread> threads;
    for (std::uint64_t& hash : hashes) {
        threads.emplace_back([&] {
            for (int i = 0; i < 5; ++i) hash = hash_of(*build_convex_hull(sphere, 100));
        });
    }
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(std::set<std::uint64_t>(hashes.begin(), hashes.end()).size(), 1u);
    EXPECT_NE(hashes[0], 0u);
}

}  // namespace
}  // namespace embody::geometry
