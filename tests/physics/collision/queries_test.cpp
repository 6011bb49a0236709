// SPDX-License-Identifier: MIT
// Rays, gaps and times of impact against closed forms and against each other.
#include <gtest/gtest.h>

#include <string>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

std::vector<ShapeDefinition> solids() {
    return {SphereShape{0.5},        BoxShape{{0.4, 0.3, 0.5}}, CapsuleShape{0.3, 0.4},
            CylinderShape{0.4, 0.5}, ConeShape{0.5, 0.5},       HullShape{corner_points({0.4, 0.3, 0.5})}};
}

TEST(Capsules, of_two_points_meet_what_the_shape_meets) {
    const auto capsule = make_shape(CapsuleShape{0.05, 0.3});
    for (const ShapeDefinition& definition : solids()) {
        const auto shape = make_shape(definition);
        Random random(5);
        for (int trial = 0; trial < 200; ++trial) {
            const Transform pose{{5, -3, 2}, random_rotation(random)};
            const Vec3 middle = pose.position + random_direction(random) * 0.7, travel = random_direction(random);
            std::vector<Manifold> own, of_shape;
            collide_capsule(middle - 0.3 * travel, middle + 0.3 * travel, 0.05, *shape, pose, 0.1, own);
            collide(*capsule, {middle, from_two_vectors({0, 1, 0}, travel)}, *shape, pose, 0.1, of_shape);
            ASSERT_EQ(own.size(), of_shape.size()) << shape_name(definition) << trial;
            if (own.empty()) continue;
            EXPECT_LT(length(own[0].normal - of_shape[0].normal), 1e-6) << shape_name(definition) << trial;
            EXPECT_NEAR(own[0].points[0].separation, of_shape[0].points[0].separation, 1e-9) << trial;
        }
    }
}

TEST(Rays, miss_the_solid_they_start_in) {
    for (const ShapeDefinition& definition : solids()) {
        const auto shape = make_shape(definition);
        EXPECT_FALSE(cast_ray(*shape, {}, {0, -0.1, 0}, {0, 1, 0}, 10)) << shape_name(definition);
    }
}

// The hit point lies on the surface, its normal is the surface's, and nothing was passed before it: told by contacts
// with a tiny sphere there.
TEST(Rays, end_on_the_surface) {
    const auto tip = make_shape(SphereShape{1e-5});
    for (const ShapeDefinition& definition : solids()) {
        const auto shape = make_shape(definition);
        Random random(21);
        int hits = 0;
        for (int trial = 0; trial < 2000; ++trial) {
            SCOPED_TRACE(std::string(shape_name(definition)) + ", trial " + std::to_string(trial));
            const Transform pose{{5, -3, 2}, random_rotation(random)};
            const Vec3 origin = pose.position + random_direction(random) * 3.0;
            const Vec3 direction = normalized(pose.position + random_direction(random) * 0.8 - origin);
            const auto hit = cast_ray(*shape, pose, origin, direction, 10);
            if (!hit) {
                for (double t = 0; t < 6; t += 0.05) {
                    ASSERT_TRUE(contacts(*shape, pose, *tip, {origin + direction * t, {}}, 0).empty());
                }
                continue;
            }
            ++hits;
            EXPECT_LT(dot(hit->normal, direction), 0);
            const Vec3 p = origin + direction * hit->distance;
            EXPECT_NEAR(separation(*tip, {p, {}}, *shape, pose, 1), -1e-5, 1.1e-5);
            const auto near = contacts(*shape, pose, *tip, {p + hit->normal * 1e-4, {}}, 1);
            ASSERT_EQ(near.size(), 1u);
            EXPECT_NEAR(deepest(near), 9e-5, 1e-6);
            EXPECT_FALSE(cast_ray(*shape, pose, origin, direction, hit->distance - 1e-6));
        }
        EXPECT_GT(hits, 300);
    }
}

TEST(Rays, meet_planes_and_triangles_from_the_front_only) {
    const auto plane = make_shape(PlaneShape{{0, 2, 0}, 1});
    const auto down = cast_ray(*plane, {}, {3, 5, 0}, {0, -1, 0}, 10);
    ASSERT_TRUE(down);
    EXPECT_NEAR(down->distance, 4, 1e-12);
    EXPECT_FALSE(cast_ray(*plane, {}, {3, 0, 0}, {0, 1, 0}, 10));

    const auto mesh = make_shape(flat_mesh(8, 1, {-4, 0, -4}));
    const auto field = make_shape(HeightfieldShape{9, 9, 1, 1, std::vector<float>(81, 0.0F)});
    Random random(2);
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 target{random.between(-4, 4), 0, random.between(-4, 4)};
        const Vec3 origin = target + Vec3{random.between(-9, 9), random.between(0.1, 9), random.between(-9, 9)};
        const Vec3 direction = normalized(target - origin);
        for (const bool is_mesh : {true, false}) {
            const auto& shape = is_mesh ? *mesh : *field;
            const Transform pose{is_mesh ? Vec3{} : Vec3{-4, 0, -4}, {}};
            const auto hit = cast_ray(shape, pose, origin, direction, 100);
            ASSERT_TRUE(hit) << trial << " " << is_mesh;
            EXPECT_NEAR(hit->distance, distance(origin, target), 1e-9);
            EXPECT_FALSE(cast_ray(shape, pose, target - direction * -5.0, -direction, 100)) << trial;
        }
    }
}

TEST(Separation, is_the_gap_of_every_pair_on_one_line) {
    const auto box = make_shape(BoxShape{{1, 1, 1}});
    for (const ShapeDefinition& definition : solids()) {
        const auto shape = make_shape(definition);
        const double top = shape->local_bounds().upper.y;
        EXPECT_NEAR(separation(*shape, {{0, -1 - top - 0.25, 0}, {}}, *box, {}, 10), 0.25, 1e-9)
            << shape_name(definition);
        EXPECT_LE(separation(*shape, {}, *box, {}, 10), 0) << shape_name(definition);
    }
    const auto plane = make_shape(PlaneShape{});
    EXPECT_NEAR(separation(*plane, {}, *box, {{0, 3, 0}, {}}, 10), 2, 1e-12);
}

TEST(TimeOfImpact, is_where_a_falling_solid_meets_the_ground) {
    const auto plane = make_shape(PlaneShape{});
    const auto slab = make_shape(BoxShape{{20, 0.01, 20}});
    const auto mesh = make_shape(flat_mesh(4, 10, {-20, 0, -20}));
    for (const ShapeDefinition& definition : solids()) {
        SCOPED_TRACE(shape_name(definition));
        const auto shape = make_shape(definition);
        const double under = -shape->local_bounds().lower.y;
        const Transform start{{0.3, 10, 0.2}, {}}, end{{0.3, -10, 0.2}, {}};
        const double truth = (10 - under) / 20;
        EXPECT_NEAR(time_of_impact(*shape, start, end, *plane, {}, 0).value_or(-1), truth, 1e-6);
        EXPECT_NEAR(time_of_impact(*shape, start, end, *slab, {{0, -0.01, 0}, {}}, 0).value_or(-1), truth, 1e-6);
        EXPECT_NEAR(time_of_impact(*shape, start, end, *mesh, {}, 0).value_or(-1), truth, 1e-6);
        // Upwards, beside and short of it: never.
        EXPECT_FALSE(time_of_impact(*shape, start, {{0.3, 30, 0.2}, {}}, *slab, {{0, -0.01, 0}, {}}, 0));
        EXPECT_FALSE(time_of_impact(*shape, {{50, 10, 0}, {}}, {{50, -10, 0}, {}}, *slab, {}, 0));
        EXPECT_FALSE(time_of_impact(*shape, start, {{0.3, 3, 0.2}, {}}, *mesh, {}, 0));
    }
}

TEST(TimeOfImpact, counts_the_turning_end_of_a_bar) {
    // A bar turns by a quarter about its middle until its end meets the wall at 0.9 of its reach: sin(angle) = 0.9.
    const auto bar = make_shape(CapsuleShape{0.01, 1});
    const auto wall = make_shape(BoxShape{{0.5, 5, 5}});
    const Transform start{}, end{{}, from_axis_angle({0, 0, 1}, -1.5707963267948966)};
    const Transform at{{1.41 - 0.01, 0, 0}, {}};
    const auto time = time_of_impact(*bar, start, end, *wall, at, 0.001);
    ASSERT_TRUE(time);
    const Quat q = end.rotation;
    const Quat mixed = normalized(Quat{q.x * *time, q.y * *time, q.z * *time, 1 + (q.w - 1) * *time});
    const double gap = separation(*bar, {{}, mixed}, *wall, at, 10);
    EXPECT_GT(gap, 0);
    EXPECT_LT(gap, 0.0015);
}

}  // namespace
}  // namespace embody::physics::collision
