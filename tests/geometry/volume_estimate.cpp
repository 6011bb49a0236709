// SPDX-License-Identifier: MIT
#include "geometry/volume_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "foundation/random.h"
#include "geometry/sample_meshes.h"
#include "geometry/topology.h"

namespace embody::geometry {
namespace {

// Checks that the estimate is within its own stated error.
void expect_honest(const VolumeEstimate& estimate, double true_volume) {
    EXPECT_LE(std::abs(estimate.solid.volume / true_volume - 1), estimate.relative_error)
        << estimate.solid.volume << " for " << true_volume;
}

TriangleMesh without_top(TriangleMesh mesh) {
    const double top = bounds(mesh).upper.y;
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return std::ranges::all_of(t, [&](auto v) { return double(mesh.positions[v].y) > top - 1e-6; });
    });
    return mesh;
}

TEST(EstimateVolume, NothingAndSheetsEncloseNothing) {
    EXPECT_EQ(estimate_volume({}).method, VolumeMethod::no_volume);
    TriangleMesh sheet;
    sheet.positions = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(estimate_volume(sheet).method, VolumeMethod::no_volume);
    EXPECT_EQ(estimate_volume(sheet).solid.center, (Vec3{0.5, 1, 0.5}));
    sheet.triangles = {{0, 0, 0}};
    EXPECT_EQ(estimate_volume(sheet).method, VolumeMethod::no_volume);
}

TEST(EstimateVolume, ClosedSoupTurnedAtRandomIsExact) {
    TriangleMesh soup = make_soup(make_box({1, 2, 3}, {5, 5, 5}));
    Random random(1);
    for (auto& t : soup.triangles) {
        if (random.below(2) == 0) std::swap(t[0], t[1]);
    }
    const VolumeEstimate estimate = estimate_volume(soup);
    EXPECT_EQ(estimate.method, VolumeMethod::closed_mesh);
    EXPECT_NEAR(estimate.solid.volume, 48, 1e-9);
    EXPECT_STREQ(name(estimate.method), "closed mesh");
}

TEST(EstimateVolume, DoubleSidedBoxCountsOnce) {
    TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh front = box;
    for (auto& t : box.triangles) std::swap(t[0], t[1]);
    append(box, front);
    EXPECT_NEAR(estimate_volume(box).solid.volume, 8, 1e-9);
}

TEST(EstimateVolume, OverlappingBoxesAreTheirUnion) {
    TriangleMesh boxes = make_box({1, 1, 1});
    append(boxes, make_box({1, 1, 1}, {1, 0, 0}));
    const VolumeEstimate estimate = estimate_volume(boxes);
    EXPECT_EQ(estimate.method, VolumeMethod::closed_parts);
    expect_honest(estimate, 12);
    EXPECT_NEAR(estimate.solid.volume, 12, 0.25);
    EXPECT_NEAR(estimate.solid.center.x, 0.5, 0.05);
}

TEST(EstimateVolume, ThinBoardsBelowACellKeepTheirVolume) {
    // A table: a 4 cm top on four legs that reach 1 cm into it. Cells are 3 cm.
    TriangleMesh table = make_box({0.6, 0.02, 0.4}, {0, 0.7, 0});
    for (const double x : {-0.5, 0.5}) {
        for (const double z : {-0.3, 0.3}) append(table, make_box({0.03, 0.345, 0.03}, {x, 0.345, z}));
    }
    const double volume = 1.2 * 0.04 * 0.8 + 4 * 0.06 * 0.06 * 0.68;
    const VolumeEstimate estimate = estimate_volume(table);
    EXPECT_EQ(estimate.method, VolumeMethod::closed_parts);
    expect_honest(estimate, volume);
    EXPECT_NEAR(estimate.solid.volume / volume, 1, 0.02);
}

TEST(EstimateVolume, HiddenInnerShellAddsNothing) {
    TriangleMesh boxes = make_box({1, 1, 1});
    append(boxes, make_box({0.5, 0.5, 0.5}));
    const VolumeEstimate estimate = estimate_volume(boxes);
    EXPECT_NEAR(estimate.solid.volume, 8, 1e-6);
    EXPECT_NEAR(estimate.solid.inertia(0, 0), 8.0 * 2 / 3, 1e-2);
}

TEST(EstimateVolume, OpenSheetBesideAClosedBoxChangesLittle) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const auto first = std::uint32_t(mesh.positions.size());
    for (const Vec3f p : {Vec3f{2, 0, 0}, Vec3f{3, 0, 0}, Vec3f{3, 0, 1}}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    const VolumeEstimate estimate = estimate_volume(mesh);
    EXPECT_EQ(estimate.method, VolumeMethod::winding_number);
    EXPECT_NEAR(estimate.solid.volume, 8, 0.05);
}

TEST(EstimateVolume, OpenBoxAndOpenCanAreNearlyFull) {
    const VolumeEstimate box = estimate_volume(without_top(make_box({0.5, 0.5, 0.5})));
    EXPECT_EQ(box.method, VolumeMethod::winding_number);
    EXPECT_GT(box.boundary_edges, 0u);
    expect_honest(box, 1);
    EXPECT_NEAR(box.solid.volume, 1, 0.15);
    const VolumeEstimate can = estimate_volume(without_top(make_cylinder(1, 2)));
    expect_honest(can, 4 * pi);
    EXPECT_NEAR(can.solid.volume / (4 * pi), 1, 0.1);
}

TEST(EstimateVolume, SphereWithRandomHolesKeepsVolumeCenterAndInertia) {
    TriangleMesh sphere = make_sphere(0.5, 80, 40, {3, 2, 1});
    Random random(8);
    std::erase_if(sphere.triangles, [&](const auto&) { return random.below(20) == 0; });
    const VolumeEstimate estimate = estimate_volume(sphere);
    EXPECT_EQ(estimate.method, VolumeMethod::winding_number);
    const double volume = 4.0 / 3 * pi * 0.125;
    expect_honest(estimate, volume);
    EXPECT_NEAR(estimate.solid.volume / volume, 1, 0.03);
    EXPECT_LE(distance(estimate.solid.center, {3, 2, 1}), 0.005);
    EXPECT_NEAR(estimate.solid.inertia(0, 0) / (0.4 * volume * 0.25), 1, 0.05);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
    const TriangleMesh torus = weld(make_torus(2, 0.5), 1e-6);
    const WindingNumber winding(torus);
    EXPECT_NEAR(winding.at({2, 0, 0}), 1, 0.06);
    EXPECT_NEAR(winding.at({0, 0, 0}), 0, 0.06);
    EXPECT_NEAR(winding.at({9, 9, 9}), 0, 0.01);
    EXPECT_EQ(WindingNumber({}).at({1, 2, 3}), 0);
}

}  // namespace
}  // namespace embody::geometry
