// SPDX-License-Identifier: MIT
#include "geometry/fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "foundation/random.h"
#include "geometry/sample_meshes.h"

namespace embody::geometry {
namespace {

const Transform anywhere{{3, -2, 5}, from_axis_angle(normalized(Vec3{1, 2, -1}), 0.7)};

ConvexHull hull_of(const TriangleMesh& mesh) {
    auto hull = build_convex_hull(mesh);
    EXPECT_TRUE(hull.ok());
    return *std::move(hull);
}
// Capsule along Y: a sphere that is stretched in the middle.
TriangleMesh make_capsule(double radius, double half_height) {
    TriangleMesh mesh = make_sphere(radius, 24, 17);
    for (Vec3f& p : mesh.positions) p.y += float(p.y > 0 ? half_height : -half_height);
    return mesh;
}

TEST(Fit, AxisAlignedBoxStaysAxisAligned) {
    const PrimitiveFit fit = fit_box(hull_of(make_box({1, 2, 3}, {4, 5, 6})));
    EXPECT_EQ(fit.local.rotation, Quat{});
    EXPECT_EQ(fit.local.position, (Vec3{4, 5, 6}));
    EXPECT_EQ(fit.half_extents, (Vec3{1, 2, 3}));
    EXPECT_LT(fit.volume_error, 1e-12);
    EXPECT_LT(fit.deviation, 1e-12);
}

TEST(Fit, RotatedBrickIsABox) {
    // The square cross-section leaves the principal axes undetermined; the directions of the faces' edges determine
    // them.
    for (const Vec3 half : {Vec3{0.1, 0.05, 0.2}, Vec3{0.1, 0.1, 0.3}, Vec3{0.1, 0.1, 0.1}}) {
        const auto fit = best_primitive(hull_of(moved(make_box(half), anywhere)));
        ASSERT_TRUE(fit.has_value());
        EXPECT_EQ(fit->kind, PrimitiveKind::box);
        std::array<double, 3> found{fit->half_extents.x, fit->half_extents.y, fit->half_extents.z};
        std::array<double, 3> given{half.x, half.y, half.z};
        std::ranges::sort(found);
        std::ranges::sort(given);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], given[k], 1e-6);
        EXPECT_LE(distance(fit->local.position, anywhere.position), 1e-6);
    }
}

TEST(Fit, NoisyBallIsASphere) {
    Random random(6);
    TriangleMesh ball = make_sphere(0.11, 40, 20, {1, 1, 1});
    for (Vec3f& p : ball.positions) {
        p = to_vec3f(Vec3{1, 1, 1} + (to_vec3(p) - Vec3{1, 1, 1}) * random.between(0.98, 1.02));
    }
    const auto fit = best_primitive(hull_of(ball));
    ASSERT_TRUE(fit.has_value());
    EXPECT_EQ(fit->kind, PrimitiveKind::sphere);
    EXPECT_NEAR(fit->radius, 0.11, 0.003);
    EXPECT_LE(distance(fit->local.position, {1, 1, 1}), 0.002);
}

TEST(Fit, TurnedCanIsACylinderAlongItsOwnAxis) {
    for (const double half_height : {0.06, 0.033, 0.01}) {
        const auto fit = best_primitive(hull_of(moved(make_cylinder(0.033, half_height, 24), anywhere)));
        ASSERT_TRUE(fit.has_value());
        EXPECT_EQ(fit->kind, PrimitiveKind::cylinder);
        EXPECT_NEAR(fit->radius, 0.033, 0.0005);
        EXPECT_NEAR(fit->half_height, half_height, 1e-6);
        EXPECT_NEAR(std::abs(dot(rotate(fit->local.rotation, {0, 1, 0}), rotate(anywhere.rotation, {0, 1, 0}))), 1,
                    1e-6);
        EXPECT_LT(fit->deviation, 0.001);
    }
}

TEST(Fit, PillIsACapsule) {
    const auto fit = best_primitive(hull_of(moved(make_capsule(0.5, 1), anywhere)));
    ASSERT_TRUE(fit.has_value());
    EXPECT_EQ(fit->kind, PrimitiveKind::capsule);
    EXPECT_NEAR(fit->radius, 0.5, 0.01);
    EXPECT_NEAR(fit->half_height, 1, 0.02);
    EXPECT_FALSE(fit_capsule(hull_of(make_sphere(1))).has_value());
}

TEST(Fit, TorusWedgeAndConeFitNoPrimitive) {
    EXPECT_FALSE(best_primitive(hull_of(make_torus(2, 0.7))).has_value());
    TriangleMesh wedge = make_box({1, 1, 1});
    wedge.positions[6] = wedge.positions[4];
    wedge.positions[7] = wedge.positions[5];
    EXPECT_FALSE(best_primitive(hull_of(wedge)).has_value());
    TriangleMesh cone = make_cylinder(1, 1);
    for (Vec3f& p : cone.positions) {
        if (p.y > 0) p.x = p.z = 0;
    }
    EXPECT_FALSE(best_primitive(hull_of(cone)).has_value());
}

TEST(Fit, DeviationIsTheHausdorffDistance) {
    // Cube of edge 2 and the sphere halfway between its faces (1) and corners (√3).
    const PrimitiveFit fit = fit_sphere(hull_of(make_box({1, 1, 1})));
    EXPECT_NEAR(fit.radius, (1 + std::sqrt(3.0)) / 2, 0.01);
    EXPECT_NEAR(fit.deviation, (std::sqrt(3.0) - 1) / 2, 0.01);
    EXPECT_FALSE(best_primitive(hull_of(make_sphere(1)), 0).has_value());
}

}  // namespace
}  // namespace embody::geometry
