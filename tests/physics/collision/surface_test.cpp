// SPDX-License-Identifier: MIT
// Triangles: one-sided, and smooth where the surface is.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
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

TEST(Surface, has_no_contacts_from_behind) {
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

// Rough ground: corners up to `rise` high, half a metre apart.
MeshShape hills(double rise) {
    MeshShape mesh = flat_mesh(12, 0.5, {-3, 0, -3});
    Random random(5);
    for (Vec3f& p : mesh.positions) p.y = static_cast<float>(random.between(-rise, rise));
    return mesh;
}

// Lowers a shape that is above the ground until the gap is `gap` (within a nanometre).
Transform lowered(const CollisionShape& shape, Transform pose, const CollisionShape& ground, double gap) {
    double high = pose.position.y, low = high - 0.01;
    const auto gap_at = [&](double y) {
        pose.position.y = y;
        return separation(shape, pose, ground, {}, 0.05);
    };
    while (gap_at(low) > gap) low -= 0.01;
    high = low + 0.01;
    while (high - low > 1e-9) (gap_at(0.5 * (low + high)) > gap ? high : low) = 0.5 * (low + high);
    pose.position.y = high;
    return pose;
}

// Triangles share the work: whatever their normals, one of them must tell the true gap, and none a deeper one. A corner
// above an edge where the ground bends away by up to 30 degrees is told along the nearer of the two normals.
TEST(Surface, on_rough_ground_the_nearest_place_is_always_found) {
    constexpr double gap = 0.004;
    for (const double rise : {0.02, 0.05, 0.3}) {
        const auto ground = make_shape(hills(rise));
        for (const auto& [name, definition] : sliders()) {
            const auto slider = make_shape(definition);
            Random random(17);
            for (int i = 0; i < 60; ++i) {
                SCOPED_TRACE(std::string(name) + ", pose " + std::to_string(i) + ", rise " + std::to_string(rise));
                const Transform above{{random.between(-2, 2), 2, random.between(-2, 2)}, random_rotation(random)};
                const auto manifolds = contacts(*slider, lowered(*slider, above, *ground, gap), *ground, {}, 0.02);
                EXPECT_FALSE(manifolds.empty());
                if (manifolds.empty()) continue;
                EXPECT_LE(deepest(manifolds), gap + 1e-6);
                EXPECT_GE(deepest(manifolds), 0.96 * gap);
                for (const Manifold& m : manifolds) EXPECT_LT(m.normal.y, 0);
            }
        }
    }
}

// Three points of a rim and a corner of a triangle make a flat tetrahedron, in which GJK once saw the origin.
TEST(Surface, the_gap_to_rough_ground_shrinks_no_faster_than_a_shape_falls) {
    constexpr double fall = 0.0017;
    const auto ground = make_shape(hills(0.02));
    for (const auto& [name, definition] : sliders()) {
        const auto slider = make_shape(definition);
        Random random(17);
        for (int i = 0; i < 60; ++i) {
            Transform pose{{random.between(-2, 2), 0.5, random.between(-2, 2)}, random_rotation(random)};
            double last = separation(*slider, pose, *ground, {}, 0.05);
            while (last > 0) {
                pose.position.y -= fall;
                const double now = separation(*slider, pose, *ground, {}, 0.05);
                ASSERT_GE(now, last - fall - 1e-9) << name << ", pose " << i << ", height " << pose.position.y;
                last = now;
            }
        }
    }
}

// A mesh and a heightfield of the same heights are the same ground.
TEST(Surface, a_heightfield_is_the_mesh_of_its_samples) {
    const MeshShape mesh = hills(0.05);
    HeightfieldShape field{13, 13, 0.5, 0.5, {}};
    for (const Vec3f& p : mesh.positions) field.heights.push_back(p.y);
    const auto as_mesh = make_shape(mesh), as_field = make_shape(field);
    for (const auto& [name, definition] : sliders()) {
        const auto slider = make_shape(definition);
        Random random(18);
        for (int i = 0; i < 40; ++i) {
            SCOPED_TRACE(std::string(name) + ", pose " + std::to_string(i));
            const Transform pose{{random.between(-3, 3), 0.2, random.between(-3, 3)}, random_rotation(random)};
            const auto on_mesh = contacts(*slider, pose, *as_mesh, {}, 0.02);
            const auto on_field = contacts(*slider, pose, *as_field, {{-3, 0, -3}, {}}, 0.02);
            ASSERT_EQ(on_mesh.size(), on_field.size());
            for (std::size_t k = 0; k < on_mesh.size(); ++k) {
                EXPECT_LT(distance(on_mesh[k].normal, on_field[k].normal), 1e-9);
                ASSERT_EQ(on_mesh[k].count, on_field[k].count);
                for (std::size_t c = 0; c < static_cast<std::size_t>(on_mesh[k].count); ++c) {
                    EXPECT_NEAR(on_mesh[k].points[c].separation, on_field[k].points[c].separation, 1e-9);
                }
            }
        }
    }
}

// Standing across the edge of a step, the step's side is not a wall in the middle of the box.
TEST(Surface, a_box_tipping_over_a_step_is_not_pushed_off_by_its_side) {
    const auto cube = make_shape(cube_mesh(1));
    const auto box = make_shape(BoxShape{{0.3, 0.25, 0.2}});
    for (const double x : {1.01, 1.1, 1.2}) {
        const auto manifolds = contacts(*box, {{x, 1.25 - 0.002, 0.1}, {}}, *cube, {}, 0.01);
        ASSERT_GE(manifolds.size(), 1u) << x;
        for (const Manifold& m : manifolds) EXPECT_GT(dot(m.normal, {0, -1, 0}), 0.999) << x;
        EXPECT_NEAR(deepest(manifolds), -0.002, 1e-6) << x;
    }
}

TEST(Surface, triangles_without_area_are_ignored) {
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
}  // namespace embody::physics::collision
