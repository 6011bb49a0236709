// SPDX-License-Identifier: MIT
#include "geometry/solid_and_shell.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/sample_meshes.h"
#include "geometry/topology.h"

namespace embody::geometry {
namespace {

// A box without the face on top (y = +half.y).
TriangleMesh open_box(Vec3 half, Vec3 center = {}) {
    TriangleMesh mesh = make_box(half, center);
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return std::ranges::all_of(t, [&](auto v) { return mesh.positions[v].y > center.y; });
    });
    return mesh;
}

TEST(IntegrateShell, OfASphereIsTwoThirdsOfMassTimesRadiusSquared) {
    const MassProperties shell = integrate_shell(make_sphere(0.5, 192, 96, {1, 2, 3}));
    EXPECT_NEAR(shell.volume, 4 * pi * 0.25, 2e-3);
    EXPECT_LT(distance(shell.center, {1, 2, 3}), 1e-6);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(shell.inertia(i, i), 2.0 / 3 * shell.volume * 0.25, 1e-3 * shell.volume);
}

TEST(IntegrateShell, OfABoxIsThatOfItsSixPlates) {
    // Each plate a × b as a rectangle, moved to its place.
    const Vec3 half{1, 2, 3};
    const auto plate = [](double a, double b, Vec3 normal_axis, Vec3 at) {
        MassProperties p;
        p.volume = a * b;
        p.center = at;
        const double ia = a * b * b * b / 12, ib = b * a * a * a / 12;
        if (normal_axis.x != 0)
            p.inertia = Mat3::diagonal({ia + ib, ia, ib});  // a along y, b along z
        else if (normal_axis.y != 0)
            p.inertia = Mat3::diagonal({ia, ia + ib, ib});  // a along x, b along z
        else
            p.inertia = Mat3::diagonal({ia, ib, ia + ib});  // a along x, b along y
        return p;
    };
    MassProperties expected;
    for (const double side : {-1.0, 1.0}) {
        expected = combined(expected, plate(4, 6, {1, 0, 0}, {side * half.x, 0, 0}));
        expected = combined(expected, plate(2, 6, {0, 1, 0}, {0, side * half.y, 0}));
        expected = combined(expected, plate(2, 4, {0, 0, 1}, {0, 0, side * half.z}));
    }
    const MassProperties shell = integrate_shell(make_box(half));
    EXPECT_NEAR(shell.volume, 88, 1e-9);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(shell.inertia(i, k), expected.inertia(i, k), 1e-9);
    }
}

TEST(IntegrateSolidAndShell, AFlatOpeningIsClosedExactly) {
    const Vec3 half{0.1, 1, 0.2}, center{3, -1, 2};
    const SolidAndShell open = integrate_solid_and_shell(open_box(half, center));
    const MassProperties whole = integrate_polyhedron(make_box(half, center));
    EXPECT_NEAR(open.solid.volume, whole.volume, 1e-7);
    EXPECT_LT(distance(open.solid.center, whole.center), 1e-6);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(open.solid.inertia(i, i), whole.inertia(i, i), 1e-7);
    EXPECT_NEAR(open.shell.volume, surface_area(make_box(half, center)) - 4 * half.x * half.z, 1e-6);
}

TEST(IntegrateSolidAndShell, ATubeOpenAtBothEndsCountsBothRims) {
    // Lateral surface 2πrh against ends of 2πr²: with narrow ends the tube is a solid, with wide ones a sheet.
    const auto tube = [](double radius, double height) {
        return weld(
            make_grid(64, 4,
                      [=](double u, double v) {
                          return Vec3{radius * std::sin(2 * pi * u), height * (0.5 - v), radius * std::cos(2 * pi * u)};
                      }),
            1e-6);
    };
    const SolidAndShell pipe = integrate_solid_and_shell(tube(0.02, 1));
    EXPECT_NEAR(pipe.solid.volume, pi * 0.02 * 0.02, 1e-5);
    EXPECT_NEAR(pipe.solid.center.y, 0, 1e-6);
    EXPECT_EQ(integrate_solid_and_shell(tube(1, 1)).solid.volume, 0);
}

TEST(IntegrateSolidAndShell, ASheetEnclosesNothing) {
    TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    const SolidAndShell result = integrate_solid_and_shell(sheet);
    EXPECT_EQ(result.solid.volume, 0);
    EXPECT_NEAR(result.shell.volume, 1, 1e-9);
    EXPECT_EQ(integrate_solid_and_shell({}).shell.volume, 0);
}

TEST(IntegrateSolidAndShell, PiecesAddUp) {
    TriangleMesh two = make_box({0.5, 0.5, 0.5}, {-2, 0, 0});
    append(two, open_box({0.1, 0.5, 0.1}, {2, 0, 0}));
    const SolidAndShell result = integrate_solid_and_shell(two);
    EXPECT_NEAR(result.solid.volume, 1 + 0.04, 1e-6);
    EXPECT_NEAR(result.solid.center.x, (-2 * 1 + 2 * 0.04) / 1.04, 1e-6);
}

}  // namespace
}  // namespace embody::geometry
