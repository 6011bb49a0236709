// SPDX-License-Identifier: MIT
// Triangles: one-sided, and smooth where the surface is.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "physics/collision/collision_probe.h"

namespace embody::physics {
namespace {

std::vector<std::pair<const char*, ShapeDefinition>> sliders() {
    return {{"sphere", SphereShape{0.25}},        {"box", BoxShape{{0.3, 0.25, 0.2}}},
            {"capsule", CapsuleShape{0.15, 0.1}}, {"cylinder", CylinderShape{0.3, 0.25}},
            {"cone", ConeShape{0.3, 0.25}},       {"hull", HullShape{corner_points({0.3, 0.25, 0.2})}}};
}

// Heights may wobble by a float's rounding: no bump is larger than that.
TEST(Surface, a_slider_never_feels_the_edges_inside_a_flat_floor) {
    const auto floor = make_shape(flat_mesh(20, 0.37, {-3, 0, -3}));
    const auto field = make_shape(HeightfieldShape{20, 20, 0.37, 0.41, std::vector<float>(400, 0.0F)});
    for (const auto& [name, definition] : sliders()) {
        const auto slider = make_shape(definition);
        Random random(8);
        for (int step = 0; step < 400; ++step) {
            SCOPED_TRACE(std::string(name) + ", step " + std::to_string(step));
            const Quat turned = from_axis_angle({0, 1, 0}, random.between(0, 6));
            const Transform pose{{-1 + 0.007 * step, 0.25 - 0.004, 0.3 - 0.003 * step}, turned};
            for (const auto* ground : {floor.get(), field.get()}) {
                const Transform at{ground == floor.get() ? Vec3{} : Vec3{-3, 0, -3}, {}};
                const auto manifolds = contacts(*slider, pose, *ground, at, 0.02);
                ASSERT_EQ(manifolds.size(), 1u);
                ASSERT_LT(distance(manifolds[0].normal, {0, -1, 0}), 1e-9);
                ASSERT_NEAR(deepest(manifolds), -0.004, 1e-9);
            }
        }
    }
}

TEST(Surface, is_not_there_from_behind) {
    const auto floor = make_shape(flat_mesh(4, 1, {-2, 0, -2}));
    for (const auto& [name, definition] : sliders()) {
        const auto slider = make_shape(definition);
        EXPECT_TRUE(contacts(*slider, {{0.1, -0.24, 0.2}, {}}, *floor, {}, 0.01).empty()) << name;
    }
}

// A closed cube of twelve triangles: a box on it or beside it stands on its faces only.
MeshShape cube_mesh(double half) {
    MeshShape mesh;
    for (const Vec3& p : corner_points({half, half, half})) mesh.positions.push_back(to_vec3f(p));
    static constexpr std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads) {
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
    }
    return mesh;
}

TEST(Surface, a_box_overhanging_a_cube_gets_no_push_from_its_sides) {
    const auto cube = make_shape(cube_mesh(1));
    for (const auto& [name, definition] : sliders()) {
        SCOPED_TRACE(name);
        const auto slider = make_shape(definition);
        for (const double x : {0.0, 0.85, 0.95, 0.99}) {
            const auto manifolds = contacts(*slider, {{x, 1.25 - 0.002, 0.1}, {}}, *cube, {}, 0.01);
            ASSERT_GE(manifolds.size(), 1u) << x;
            for (const Manifold& m : manifolds) {
                EXPECT_GT(dot(m.normal, {0, -1, 0}), 0.999) << x;
            }
            EXPECT_NEAR(deepest(manifolds), -0.002, 1e-6) << x;
        }
    }
}

TEST(Surface, a_ball_rolls_around_a_sharp_edge) {
    // Over the edge the normal turns from one face's to the other's.
    const auto cube = make_shape(cube_mesh(1));
    const auto ball = make_shape(SphereShape{0.2});
    for (const double angle : {0.1, 0.5, 0.8, 1.2, 1.5}) {
        const Vec3 out{std::sin(angle), std::cos(angle), 0};
        const auto manifolds = contacts(*ball, {Vec3{1, 1, 0.3} + out * 0.199, {}}, *cube, {}, 0.01);
        ASSERT_EQ(manifolds.size(), 1u) << angle;
        EXPECT_EQ(manifolds[0].count, 1);
        EXPECT_LT(distance(manifolds[0].normal, -out), 1e-6) << angle;
        EXPECT_NEAR(deepest(manifolds), -0.001, 1e-9);
    }
}

TEST(Surface, a_box_in_a_corner_touches_floor_and_wall) {
    // An L of two quads that meet in a concave edge.
    MeshShape corner{{{0, 0, -2}, {0, 0, 2}, {3, 0, 2}, {3, 0, -2}, {0, 3, -2}, {0, 3, 2}},
                     {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 1}}};
    const auto mesh = make_shape(corner);
    const auto box = make_shape(BoxShape{{0.5, 0.5, 0.5}});
    const auto manifolds = contacts(*box, {{0.499, 0.498, 0}, {}}, *mesh, {}, 0.01);
    ASSERT_EQ(manifolds.size(), 2u);
    for (const Manifold& m : manifolds) {
        EXPECT_EQ(m.count, 4);
        const bool is_floor = m.normal.y < -0.999;
        EXPECT_TRUE(is_floor || m.normal.x < -0.999);
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(m.points[static_cast<std::size_t>(i)].separation, is_floor ? -0.002 : -0.001, 1e-9);
        }
    }
}

TEST(Surface, triangles_without_area_are_passed_over) {
    MeshShape mesh = flat_mesh(2, 1, {-1, 0, -1});
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({0, 1, 2});
    const auto floor = make_shape(mesh);
    const auto ball = make_shape(SphereShape{0.5});
    const auto manifolds = contacts(*ball, {{0, 0.49, 0}, {}}, *floor, {}, 0);
    ASSERT_EQ(manifolds.size(), 1u);
    EXPECT_NEAR(deepest(manifolds), -0.01, 1e-9);
}

}  // namespace
}  // namespace embody::physics
