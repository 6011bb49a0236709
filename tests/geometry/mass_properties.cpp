// SPDX-License-Identifier: MIT
#include "geometry/mass_properties.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/sample_meshes.h"

namespace embody::geometry {
namespace {

void expect_near(Vec3 a, Vec3 b, double tolerance) { EXPECT_LE(distance(a, b), tolerance); }
void expect_near(const Mat3& a, const Mat3& b, double tolerance) {
    for (int i = 0; i < 3; ++i) expect_near(a.column(i), b.column(i), tolerance);
}
Mat3 box_inertia(double volume, Vec3 half) {
    const Vec3 s = scale(half, half) * (volume / 3);
    return Mat3::diagonal({s.y + s.z, s.x + s.z, s.x + s.y});
}

TEST(Validate, RefusesIndexBeyondVertices) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.triangles[3][1] = 8;
    const auto result = validate(mesh);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().where, "triangle 3");
}

TEST(Validate, RefusesVertexThatIsNotFinite) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.positions[7].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(validate(mesh).ok());
    mesh.positions[7].y = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(validate(mesh).ok());
    mesh.positions[7].y = 1;
    EXPECT_TRUE(validate(mesh).ok());
}

TEST(Bounds, IgnoreVerticesThatNoTriangleUses) {
    TriangleMesh mesh = make_box({1, 2, 3}, {1, 0, 0});
    mesh.positions.push_back({1000, 0, 0});
    EXPECT_EQ(bounds(mesh).upper, (Vec3{2, 2, 3}));
    EXPECT_TRUE(bounds(TriangleMesh{}).is_empty());
}

TEST(SurfaceArea, OfABox) { EXPECT_DOUBLE_EQ(surface_area(make_box({1, 2, 3})), 88); }

TEST(IntegratePolyhedron, EmptyMeshHasNoVolume) {
    const MassProperties p = integrate_polyhedron({});
    EXPECT_EQ(p.volume, 0);
    EXPECT_EQ(p.center, Vec3{});
}

TEST(IntegratePolyhedron, BoxMatchesClosedForm) {
    const Vec3 half{0.5, 1, 2};
    const MassProperties p = integrate_polyhedron(make_box(half, {3, -4, 5}));
    EXPECT_NEAR(p.volume, 8, 1e-12);
    expect_near(p.center, {3, -4, 5}, 1e-12);
    expect_near(p.inertia, box_inertia(8, half), 1e-11);
}

TEST(IntegratePolyhedron, TetrahedronMatchesClosedForm) {
    // Corner tetrahedron of the unit cube: V = 1/6, ∫x² = 1/60, ∫xy = 1/120.
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const MassProperties p = integrate_polyhedron(mesh);
    EXPECT_NEAR(p.volume, 1.0 / 6, 1e-15);
    expect_near(p.center, {0.25, 0.25, 0.25}, 1e-15);
    const double square = 1.0 / 60 - 1.0 / 96, product = 1.0 / 120 - 1.0 / 96;
    const Mat3 expected{
        {2 * square, -product, -product}, {-product, 2 * square, -product}, {-product, -product, 2 * square}};
    expect_near(p.inertia, expected, 1e-15);
}

TEST(IntegratePolyhedron, FineSphereApproachesClosedFormQuadratically) {
    const auto error = [](int n) {
        return std::abs(integrate_polyhedron(make_sphere(0.7, 2 * n, n)).volume / (4.0 / 3 * pi * 0.343) - 1);
    };
    EXPECT_NEAR(error(32) / error(64), 4, 0.1);
    EXPECT_LT(error(64), 2e-3);
    const MassProperties p = integrate_polyhedron(make_sphere(0.7, 256, 128));
    const double moment = 0.4 * p.volume * 0.49;
    EXPECT_NEAR(p.inertia(0, 0) / moment, 1, 1e-3);
    EXPECT_NEAR(p.inertia(1, 1) / moment, 1, 1e-3);
    EXPECT_NEAR(p.inertia(0, 1) / moment, 0, 1e-6);
}

TEST(IntegratePolyhedron, MovedMeshEqualsMovedProperties) {
    const Transform t{{10, -3, 7}, from_axis_angle(normalized(Vec3{1, 2, 3}), 1.1)};
    const TriangleMesh mesh = make_cylinder(0.4, 1.3);
    const MassProperties a = integrate_polyhedron(moved(mesh, t));
    const MassProperties b = transformed(t, integrate_polyhedron(mesh));
    // Single precision positions at 10 m carry 1e-6 m.
    EXPECT_NEAR(a.volume, b.volume, 1e-5);
    expect_near(a.center, b.center, 1e-6);
    expect_near(a.inertia, b.inertia, 1e-5);
}

TEST(IntegratePolyhedron, FarFromOriginKeepsItsDigits) {
    // 4096 m away: float positions are exact here, so only the summation can lose digits.
    const MassProperties p = integrate_polyhedron(make_box({0.5, 0.5, 0.5}, {4096, 4096, -4096}));
    EXPECT_NEAR(p.volume, 1, 1e-13);
    expect_near(p.inertia, box_inertia(1, {0.5, 0.5, 0.5}), 1e-13);
}

TEST(IntegratePolyhedron, InsideOutIsNegative) {
    TriangleMesh mesh = make_box({1, 1, 1});
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    EXPECT_NEAR(integrate_polyhedron(mesh).volume, -8, 1e-12);
}

TEST(Combined, TwoHalvesAreTheWhole) {
    const MassProperties left = integrate_polyhedron(make_box({0.5, 1, 1}, {-0.5, 0, 0}));
    const MassProperties right = integrate_polyhedron(make_box({0.5, 1, 1}, {0.5, 0, 0}));
    const MassProperties whole = combined(left, right);
    EXPECT_NEAR(whole.volume, 8, 1e-12);
    expect_near(whole.center, {0, 0, 0}, 1e-14);
    expect_near(whole.inertia, box_inertia(8, {1, 1, 1}), 1e-12);
    EXPECT_EQ(combined({}, {}).volume, 0);
}

TEST(ParallelAxis, RodAboutItsEnd) {
    // m L²/12 about the centre becomes m L²/3 about the end.
    const Mat3 rod = Mat3::diagonal({0, 3.0 * 4 / 12, 3.0 * 4 / 12});
    expect_near(inertia_about(rod, 3, {1, 0, 0}), Mat3::diagonal({0, 4, 4}), 1e-15);
}

}  // namespace
}  // namespace embody::geometry
