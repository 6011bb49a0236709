// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "benches/race/engine.h"
#include "benches/race/overlap.h"

namespace embody::race {
namespace {

/// A scene with one box of 1 m on the ground and another shape above it.
RaceScene two_bodies(RaceShape upper) {
    RaceScene scene{.name = "two", .shapes = {make_box({0.5, 0.5, 0.5}), std::move(upper)}};
    scene.bodies = {{.shape = 0}, {.shape = 1}};
    return scene;
}

Overlap overlap_at(const RaceScene& scene, Vec3 upper, Quat rotation = {}) {
    const BodyState states[] = {{.position = {0, 0.5, 0}}, {.position = upper, .rotation = rotation}};
    return measure_overlap(scene, scene.bodies, states);
}

TEST(race_scenes, unknown_names_are_refused) { EXPECT_FALSE(make_race_scene("table1_z").has_value()); }

TEST(race_scenes, have_the_bodies_they_are_known_by) {
    const std::pair<const char*, std::size_t> known[] = {
        {"table1_e", 55},  {"table1_f", 210},  {"table1_g", 343},      {"big_pyramid", 1830}, {"pile_5k", 5000},
        {"mesh_1k", 1000}, {"tall_stack", 30}, {"hi_restitution", 10}, {"mass_ratio_2", 2},   {"mass_ratio_5", 5}};
    ASSERT_EQ(std::size(known), race_scene_names().size());
    for (const auto& [name, bodies] : known) {
        const auto scene = make_race_scene(name);
        ASSERT_TRUE(scene) << name;
        EXPECT_EQ(scene->bodies.size(), bodies) << name;
    }
}

// Earlier figures and those of other engines were measured with exactly these numbers.
TEST(race_scenes, keep_their_random_numbers) {
    const auto pen = make_race_scene("table1_g");
    EXPECT_DOUBLE_EQ(pen->bodies.back().position.x, 2.9771544554935008);
    EXPECT_DOUBLE_EQ(pen->bodies.back().rotation.w, -0.59809437243975816);
    const auto pile = make_race_scene("pile_5k");
    EXPECT_DOUBLE_EQ(pile->bodies.back().position.z, -2.437530370647186);
    EXPECT_DOUBLE_EQ(pile->shapes.back().volume, 0.028942523838306106);
    const auto mesh = make_race_scene("mesh_1k");
    EXPECT_DOUBLE_EQ(mesh->bodies.back().position.x, -1.9678928746518165);
    EXPECT_NEAR(mesh->shapes.back().inertia(0, 1), -0.00025442132855140327, 1e-15);
}

TEST(race_scenes, start_without_overlap) {
    for (const std::string_view name : race_scene_names()) {
        const auto scene = make_race_scene(name);
        std::vector<BodyState> states;
        for (const RaceBody& body : scene->bodies)
            states.push_back({.position = body.position, .rotation = body.rotation});
        const Overlap overlap = measure_overlap(*scene, scene->bodies, states);
        EXPECT_EQ(overlap.escaped, 0) << name;
        EXPECT_LT(overlap.bodies, 1e-12) << name;
        EXPECT_LT(overlap.statics, 1e-12) << name;
    }
}

TEST(race_shapes, box_and_its_polytope_agree) {
    const RaceShape box = make_box({0.5, 1, 1.5});
    EXPECT_NEAR(box.volume, 6, 1e-12);
    EXPECT_NEAR(box.inertia(0, 0), 6.0 / 12 * (4 + 9), 1e-12);
    EXPECT_EQ(box.face_normals.size(), 6u);
    EXPECT_EQ(box.edge_directions.size(), 3u);
}

TEST(race_shapes, hulls_keep_all_vertices_and_are_closed) {
    SceneRandom random;
    for (int count = 16; count <= 32; ++count) {
        const RaceShape hull = make_hull(random, count, 0.5);
        // Euler's formula for a closed surface of triangles.
        EXPECT_EQ(hull.triangles.size(), static_cast<std::size_t>(2 * count - 4));
        Vec3 area;
        for (const auto& t : hull.triangles) {
            const auto corner = [&](std::size_t k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
            area += cross(corner(1) - corner(0), corner(2) - corner(0));
        }
        EXPECT_LT(length(area), 1e-12);
        EXPECT_GT(hull.volume, 0);
    }
}

TEST(race_overlap, bodies_below_the_ground_or_at_no_finite_position_have_escaped) {
    const RaceScene scene = two_bodies(make_sphere(0.5));
    EXPECT_EQ(overlap_at(scene, {0, std::nan(""), 0}).escaped, 1);
    EXPECT_EQ(overlap_at(scene, {3, -0.1, 0}).escaped, 1);
    EXPECT_EQ(overlap_at(scene, {3, 0.4, 0}).escaped, 0);
}

TEST(race_overlap, is_the_depth_of_each_pair_of_kinds) {
    // 1 cm into the box's top; the rotated box stands on an edge.
    EXPECT_NEAR(overlap_at(two_bodies(make_sphere(0.5)), {0, 1.49, 0}).bodies, 0.01, 1e-12);
    EXPECT_NEAR(overlap_at(two_bodies(make_box({0.5, 0.5, 0.5})), {0.2, 1.49, 0}).bodies, 0.01, 1e-12);
    EXPECT_NEAR(overlap_at(two_bodies(make_cylinder(0.5, 0.5)), {0, 1.49, 0}).bodies, 0.01, 1e-12);
    const double half_diagonal = std::numbers::sqrt2 / 2;
    EXPECT_NEAR(overlap_at(two_bodies(make_box({0.5, 0.5, 0.5})), {0, 0.99 + half_diagonal, 0},
                           from_axis_angle({1, 0, 0}, std::numbers::pi / 4))
                    .bodies,
                0.01, 1e-12);
    EXPECT_LE(overlap_at(two_bodies(make_box({0.5, 0.5, 0.5})), {0, 1.51, 0}).bodies, 0);
}

TEST(race_overlap, is_the_depth_in_terrain_along_its_normal) {
    auto scene = *make_race_scene("mesh_1k");
    scene.shapes = {make_sphere(0.05)};
    scene.bodies = {{.shape = 0}};
    // Above the centre of one triangle, small enough to meet no other: both halves of a cell.
    const Terrain& terrain = scene.terrain;
    for (const std::size_t triangle : {std::size_t{240 * 240}, std::size_t{240 * 240 + 1}}) {
        const auto corner = [&](std::size_t k) {
            return terrain.vertices[static_cast<std::size_t>(terrain.indices[3 * triangle + k])];
        };
        const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
        ASSERT_GT(normal.y, 0);
        const Vec3 centre = (corner(0) + corner(1) + corner(2)) / 3.0 + 0.04 * normal;
        const BodyState state[] = {{.position = centre}};
        EXPECT_NEAR(measure_overlap(scene, scene.bodies, state).statics, 0.01, 1e-12);
    }
}

TEST(race_embody, steps_the_scenes_without_losing_a_body) {
    for (const std::string_view name : {"tall_stack", "table1_g"}) {
        const auto scene = make_race_scene(name);
        auto engine = make_embody_engine(*scene, {});
        ASSERT_TRUE(engine) << engine.error().message();
        for (const RaceBody& body : scene->bodies) ASSERT_TRUE((*engine)->add_body(body));
        (*engine)->step();
        for (std::size_t i = 0; i < scene->bodies.size(); ++i)
            EXPECT_LT(distance((*engine)->state(i).position, scene->bodies[i].position), 0.01);
        EXPECT_FALSE((*engine)->stages().empty());
    }
}

}  // namespace
}  // namespace embody::race
