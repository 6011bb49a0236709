// SPDX-License-Identifier: MIT
// What a shape refuses, and what it knows of itself: mass, bounds, reach.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "physics/collision/collision_probe.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ShapeDefinition, refuses_by_field) {
    struct Wrong {
        ShapeDefinition definition;
        const char* where;
    };
    HeightfieldShape field{3, 5, 1, 1, std::vector<float>(15, 0.0F)};
    field.heights[12] = std::numeric_limits<float>::quiet_NaN();
    HeightfieldShape few{3, 5, 1, 1, std::vector<float>(14, 0.0F)};
    MeshShape mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}}};
    MeshShape far = mesh;
    far.positions[1].y = std::numeric_limits<float>::infinity();
    CompoundShape compound{{{SphereShape{1}, {}}, {CapsuleShape{-1, 1}, {}}}};
    CompoundShape turned{{{SphereShape{1}, {{}, {0, 0, 0, 2}}}}};
    const Wrong wrongs[] = {{SphereShape{0}, "radius"},
                            {SphereShape{-1}, "radius"},
                            {SphereShape{nan}, "radius"},
                            {SphereShape{inf}, "radius"},
                            {SphereShape{1e38}, "radius"},
                            {SphereShape{5e-324}, "radius"},
                            {BoxShape{{1, 0, 1}}, "half_extents.y"},
                            {CapsuleShape{1, nan}, "half_height"},
                            {CylinderShape{0, 1}, "radius"},
                            {ConeShape{1, -2}, "half_height"},
                            {HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, "points"},
                            {HullShape{{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {0, 0, 1}}}, "points[2]"},
                            {HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}, "points"},
                            {HullShape{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, "points"},
                            {PlaneShape{{0, 0, 0}, 0}, "normal"},
                            {PlaneShape{{0, 1, 0}, inf}, "offset"},
                            {HeightfieldShape{1, 5, 1, 1, {}}, "columns"},
                            {HeightfieldShape{2, 1, 1, 1, {}}, "rows"},
                            {few, "heights"},
                            {field, "heights[12]"},
                            {MeshShape{}, "positions"},
                            {MeshShape{mesh.positions, {}}, "triangles"},
                            {mesh, "triangles[1]"},
                            {far, "positions[1]"},
                            {CompoundShape{}, "children"},
                            {compound, "children[1].radius"},
                            {turned, "children[0].local.rotation"}};
    for (const Wrong& wrong : wrongs) {
        SCOPED_TRACE(std::string(shape_name(wrong.definition)) + " " + wrong.where);
        const auto made = CollisionShape::create(wrong.definition);
        ASSERT_FALSE(made.ok());
        EXPECT_EQ(made.error().where, wrong.where);
        EXPECT_FALSE(made.error().why.empty());
    }
}

TEST(ShapeDefinition, has_a_name_and_knows_what_cannot_move) {
    EXPECT_STREQ(shape_name(SphereShape{}), "sphere");
    EXPECT_STREQ(shape_name(CompoundShape{}), "compound");
    EXPECT_TRUE(is_static_only(PlaneShape{}));
    EXPECT_TRUE(is_static_only(HeightfieldShape{}));
    EXPECT_TRUE(is_static_only(MeshShape{}));
    EXPECT_FALSE(is_static_only(HullShape{}));
}

void expect_inertia(const Mat3& inertia, Vec3 diagonal, double tolerance) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(inertia(r, c), r == c ? diagonal[r] : 0, tolerance) << r << c;
    }
}

TEST(ShapeMass, follows_the_closed_forms) {
    const double pi = std::numbers::pi;
    const auto sphere = make_shape(SphereShape{2});
    EXPECT_NEAR(sphere->mass_properties().volume, 32 * pi / 3, 1e-12);
    const auto box = make_shape(BoxShape{{1, 2, 3}});
    EXPECT_NEAR(box->mass_properties().volume, 48, 1e-12);
    expect_inertia(box->mass_properties().inertia, {48.0 / 3 * (4 + 9), 48.0 / 3 * (1 + 9), 48.0 / 3 * (1 + 4)}, 1e-11);
    const auto cone = make_shape(ConeShape{1, 1.5});
    EXPECT_NEAR(cone->mass_properties().volume, pi, 1e-12);
    EXPECT_NEAR(cone->mass_properties().center.y, -0.75, 1e-12);
}

// Independent of the formulas: counting random points inside.
TEST(ShapeMass, agrees_with_counting_points_inside) {
    Random random(3);
    HullShape cloud;
    for (int i = 0; i < 60; ++i) cloud.points.push_back(random_direction(random) + Vec3{0.3, 0.1, -0.2});
    const ShapeDefinition shapes[] = {CapsuleShape{0.5, 0.7}, CylinderShape{0.6, 0.4}, ConeShape{0.8, 0.6}, cloud};
    for (const ShapeDefinition& definition : shapes) {
        SCOPED_TRACE(shape_name(definition));
        const auto shape = make_shape(definition);
        const Bounds b = shape->local_bounds();
        const auto probe = make_shape(SphereShape{1e-6});
        constexpr int count = 60000;
        int inside = 0;
        Vec3 sum, squares;
        for (int i = 0; i < count; ++i) {
            const Vec3 p{random.between(b.lower.x, b.upper.x), random.between(b.lower.y, b.upper.y),
                         random.between(b.lower.z, b.upper.z)};
            if (contacts(*shape, {}, *probe, {p, {}}, 0).empty()) continue;
            ++inside;
            sum += p;
            squares += scale(p, p);
        }
        const Vec3 s = b.size();
        const double volume = s.x * s.y * s.z * inside / count;
        const auto& mass = shape->mass_properties();
        EXPECT_NEAR(volume, mass.volume, 0.02 * mass.volume);
        const Vec3 center = sum / inside;
        EXPECT_LT(distance(center, mass.center), 0.01);
        const Vec3 moments = (squares / inside - scale(center, center)) * mass.volume;
        EXPECT_NEAR(moments.y + moments.z, mass.inertia(0, 0), 0.03 * mass.inertia(0, 0));
        EXPECT_NEAR(moments.x + moments.z, mass.inertia(1, 1), 0.03 * mass.inertia(1, 1));
        EXPECT_NEAR(moments.x + moments.y, mass.inertia(2, 2), 0.03 * mass.inertia(2, 2));
    }
}

TEST(ShapeMass, two_halves_make_the_whole_box) {
    const auto whole = make_shape(BoxShape{{1, 0.5, 0.5}});
    const CompoundShape halves{{{BoxShape{{0.5, 0.5, 0.5}}, {{-0.5, 0, 0}, {}}},
                                {HullShape{corner_points({0.5, 0.5, 0.5})}, {{0.5, 0, 0}, {}}}}};
    const auto joined = make_shape(halves);
    EXPECT_NEAR(joined->mass_properties().volume, 2, 1e-12);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(joined->mass_properties().inertia(k, k), whole->mass_properties().inertia(k, k), 1e-12);
    }
}

TEST(ShapeBounds, hold_every_surface_point_and_touch_the_farthest) {
    Random random(11);
    std::vector<Vec3> points;
    for (int i = 0; i < 13; ++i) points.push_back(random_direction(random) * 0.6);
    const ShapeDefinition shapes[] = {SphereShape{0.4},        BoxShape{{0.2, 0.7, 0.3}}, CapsuleShape{0.3, 0.6},
                                      CylinderShape{0.5, 0.2}, ConeShape{0.5, 0.8},       HullShape{points}};
    for (const ShapeDefinition& definition : shapes) {
        const auto shape = make_shape(definition);
        for (int trial = 0; trial < 50; ++trial) {
            const Transform pose{random_direction(random), random_rotation(random)};
            const Bounds bounds = shape->bounds(pose);
            Bounds sampled;
            const PlacedConvex placed = place(shape->data().pieces[0], pose, {});
            for (int i = 0; i < 2000; ++i) {
                const Vec3 d = random_direction(random);
                sampled.add(core_support(placed, d) + d * rounding(*placed.shape));
            }
            EXPECT_TRUE(contains(enlarged(bounds, 1e-12), sampled));
            EXPECT_TRUE(contains(enlarged(sampled, 0.05), bounds));
            EXPECT_LE(length(sampled.upper - pose.position), std::sqrt(3.0) * shape->radius_about({}));
        }
    }
    const auto plane = make_shape(PlaneShape{});
    EXPECT_TRUE(is_finite(plane->bounds({}).size()));
    EXPECT_EQ(plane->bounds({}).upper.y, 0);
}

}  // namespace
}  // namespace embody::physics::collision
