// SPDX-License-Identifier: MIT
// Sheets and lines that are made of thin things.
#include "scene/embody/thin_form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/embody/shape_surface.h"

namespace embody::scene {
namespace {

using attributes::SheetMesh;
using physics::BoxShape;
using physics::CylinderShape;

constexpr double pi = 3.14159265358979;

double area_of(const SheetMesh& sheet) {
    double area = 0;
    for (const auto& [a, b, c] : sheet.triangles)
        area += length(cross(sheet.nodes[b] - sheet.nodes[a], sheet.nodes[c] - sheet.nodes[a])) / 2;
    return area;
}

double length_of(const std::vector<Vec3>& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += distance(line[i], line[i - 1]);
    return sum;
}

TEST(SheetForm, IsTheMiddlePlaneOfAThinBoxWhicheverWayItLies) {
    for (const Vec3 half : {Vec3{0.5, 0.002, 0.8}, {0.002, 0.5, 0.8}, {0.8, 0.5, 0.002}}) {
        const auto sheet = sheet_of(physics::ShapeDefinition{BoxShape{half}}, 500);
        ASSERT_TRUE(sheet) << sheet.error().message();
        EXPECT_NEAR(area_of(*sheet), 1.6, 1e-9);
        EXPECT_NEAR(static_cast<double>(sheet->nodes.size()), 500, 60);
        for (const Vec3 node : sheet->nodes) {
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_LE(std::fabs(node[axis]), half[axis] > 0.01 ? half[axis] + 1e-9 : 1e-12);
        }
    }
}

TEST(SheetForm, ADiscIsRound) {
    const auto sheet = sheet_of(physics::ShapeDefinition{CylinderShape{0.6, 0.003}}, 800);
    ASSERT_TRUE(sheet);
    EXPECT_NEAR(area_of(*sheet), pi * 0.36, 0.01);
    EXPECT_NEAR(static_cast<double>(sheet->nodes.size()), 800, 90);
    for (const Vec3 node : sheet->nodes) EXPECT_LE(std::hypot(node.x, node.z), 0.6 + 1e-9);
}

TEST(SheetForm, KeepsTheOutlineAndTheLargestPart) {
    // An L of two thin boxes, and a crumb beside it.
    physics::CompoundShape shape;
    shape.children = {{BoxShape{{0.5, 0.005, 0.1}}, {{0, 0, 0}, {}}},
                      {BoxShape{{0.1, 0.005, 0.4}}, {{-0.4, 0, 0.5}, {}}},
                      {BoxShape{{0.04, 0.005, 0.04}}, {{0.45, 0, 0.85}, {}}}};
    const auto sheet = sheet_of(physics::ShapeDefinition{shape}, 2000);
    ASSERT_TRUE(sheet) << sheet.error().message();
    EXPECT_NEAR(area_of(*sheet), 0.2 + 0.16, 0.02);
    for (const Vec3 node : sheet->nodes) EXPECT_FALSE(node.x > 0.3 && node.z > 0.5) << "the crumb";
}

TEST(SheetForm, RefusesWhatIsThickAndSaysWhy) {
    const auto thick = sheet_of(physics::ShapeDefinition{BoxShape{{0.2, 0.2, 0.2}}}, 100);
    ASSERT_FALSE(thick);
    EXPECT_NE(thick.error().why.find("0.4 m thick"), std::string::npos) << thick.error().why;
    EXPECT_FALSE(sheet_of(physics::ShapeDefinition{physics::SphereShape{0.2}}, 100));
    EXPECT_FALSE(sheet_of(physics::ShapeDefinition{physics::PlaneShape{}}, 100));
    EXPECT_FALSE(sheet_of(physics::ShapeDefinition{CylinderShape{0.1, 0.5}}, 100));
}

TEST(LineForm, RunsBetweenTheEndsOfLongThings) {
    const auto capsule = line_of(physics::ShapeDefinition{physics::CapsuleShape{0.02, 1}}, 20);
    ASSERT_TRUE(capsule);
    EXPECT_EQ(capsule->nodes.size(), 21u);
    EXPECT_EQ(capsule->nodes.front(), (Vec3{0, -1, 0}));
    EXPECT_EQ(capsule->nodes.back(), (Vec3{0, 1, 0}));
    EXPECT_EQ(capsule->diameter, 0.04);
    const auto box = line_of(physics::ShapeDefinition{BoxShape{{1, 0.02, 0.01}}}, 10);
    ASSERT_TRUE(box);
    EXPECT_NEAR(length_of(box->nodes), 2, 1e-12);
    EXPECT_NEAR(box->diameter, 2 * std::sqrt(2e-4), 1e-12);
    const auto ball = line_of(physics::ShapeDefinition{physics::SphereShape{1}}, 10);
    ASSERT_FALSE(ball);
    EXPECT_NE(ball.error().why.find("no rope"), std::string::npos);
}

TEST(LineForm, FollowsTheMiddleOfASurface) {
    // A tube of radius 1 cm along the arc y = x² / 2.
    geometry::TriangleMesh tube;
    const int rings = 80, sides = 16;
    for (int i = 0; i <= rings; ++i) {
        const double x = 2.0 * i / rings - 1;
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * pi * k / sides;
            tube.positions.push_back(to_vec3f(Vec3{x, x * x / 4 + 0.01 * std::cos(angle), 0.01 * std::sin(angle)}));
        }
    }
    for (std::uint32_t i = 0; i < rings; ++i) {
        for (std::uint32_t k = 0; k < sides; ++k) {
            const std::uint32_t a = i * sides + k, b = i * sides + (k + 1) % sides;
            tube.triangles.push_back({a, b, a + sides});
            tube.triangles.push_back({b, b + sides, a + sides});
        }
    }
    const auto line = line_of(tube, 20);
    ASSERT_TRUE(line) << line.error().message();
    for (const Vec3 node : line->nodes) EXPECT_NEAR(node.y, node.x * node.x / 4, 0.015);
    EXPECT_NEAR(line->diameter, 0.02, 0.004);
}

}  // namespace
}  // namespace embody::scene
