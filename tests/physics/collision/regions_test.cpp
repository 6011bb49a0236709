// SPDX-License-Identifier: MIT
// Parts of contact regions: which points stay, how polygons are clipped, where lines cross; triangles of surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/collision/collision_probe.h"
#include "physics/collision/pairs/box_pair.h"
#include "physics/collision/pairs/choose_four.h"
#include "physics/collision/pairs/contact_region.h"
#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/curve_crossing.h"
#include "physics/collision/pairs/disc_region.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/collision/pairs/pair_memory.h"
#include "physics/collision/pairs/round_features.h"
#include "physics/collision/pairs/surface_pair.h"
#include "physics/collision/pairs/triangle_pairs.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/collision/shapes/near_triangles.h"
#include "physics/collision/shapes/placed_triangle.h"
#include "physics/collision/shapes/triangle_surface.h"

namespace embody::physics::collision {
namespace {

Vec3 any_point(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
const Convex& convex_of(const CollisionShape& shape) { return shape.data().pieces.front().convex; }
PlacedConvex placed(const CollisionShape& shape, Quat rotation, Vec3 position) {
    return {&convex_of(shape), to_matrix(rotation), position};
}

TEST(ChooseFour, KeepsFewPointsAsTheyAre) {
    const FlatPoint points[] = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
    EXPECT_EQ(choose_four(points, 0).count, 0);
    EXPECT_EQ(choose_four(points, 1).count, 1);
    const ChosenPoints three = choose_four(points, 3);
    EXPECT_EQ(three.count, 3);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(three.holds(i));
    EXPECT_FALSE(three.holds(3));
    const FlatPoint twins[] = {{0, 0, -1}, {0, 0, -1}, {1, 0, -1}};
    EXPECT_EQ(choose_four(twins, 3).count, 2);
}

TEST(ChooseFour, TakesTheCornersOfASquareAndTheDeepest) {
    Random random(1);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<FlatPoint> points;
        for (int i = 0; i < 4; ++i) points.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, -0.01});
        for (int i = 0; i < 6; ++i) points.push_back({random.between(-0.7, 0.7), random.between(-0.7, 0.7), -0.01});
        std::swap(points[random.below(10)], points[random.below(10)]);
        const ChosenPoints chosen = choose_four(points.data(), 10);
        ASSERT_EQ(chosen.count, 4);
        for (const int i : std::span(chosen.index)) EXPECT_EQ(std::fabs(points[static_cast<std::size_t>(i)].x), 1);
        EXPECT_FALSE(leaves_unseen(points.data(), 10, chosen, 1e-3));
        // One in the middle that is deeper is kept, whatever it spans; else it would sink unseen.
        points.push_back({0.1, 0.2, -0.5});
        EXPECT_TRUE(leaves_unseen(points.data(), 11, chosen, 1e-3));
        EXPECT_TRUE(choose_four(points.data(), 11).holds(10));
    }
}

TEST(FeatureNames, DifferByOrderAndCountOfFeatures) {
    EXPECT_EQ(feature_name({1, 2, 3}), feature_name({1, 2, 3}));
    EXPECT_NE(feature_name({1, 2, 3}), feature_name({1, 3, 2}));
    EXPECT_NE(feature_name({1, 2}), feature_name({1, 2, 0}));
}

ContactFeature square(double half, Vec3 center, Vec3 normal) {
    ContactFeature feature;
    const double s = normal.y;
    feature.points = {center + Vec3{-half, 0, half * s}, center + Vec3{half, 0, half * s},
                      center + Vec3{half, 0, -half * s}, center + Vec3{-half, 0, -half * s}};
    feature.normal = normal;
    return feature;
}

TEST(ContactRegion, IsTheCommonPartOfTwoSquares) {
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 displacement{random.between(-1.4, 1.4), 0.02, random.between(-1.4, 1.4)};
        ContactRegion region;
        region.normal = {0, 1, 0};
        clip_to_region(square(1, {}, {0, 1, 0}), square(0.5, displacement, {0, -1, 0}), true, 0, 0.05, region);
        ASSERT_EQ(region.points.size(), 4u);
        const double low_x = std::max(-1.0, displacement.x - 0.5), high_x = std::min(1.0, displacement.x + 0.5);
        const double low_z = std::max(-1.0, displacement.z - 0.5), high_z = std::min(1.0, displacement.z + 0.5);
        for (const ManifoldPoint& point : region.points) {
            EXPECT_NEAR(point.separation, 0.02, 1e-12);
            EXPECT_NEAR(point.position.y, 0.01, 1e-12);
            EXPECT_LT(std::min(std::fabs(point.position.x - low_x), std::fabs(point.position.x - high_x)), 1e-8);
            EXPECT_LT(std::min(std::fabs(point.position.z - low_z), std::fabs(point.position.z - high_z)), 1e-8);
        }
    }
    // What is farther than the margin, or aside, is not in it.
    ContactRegion none;
    none.normal = {0, 1, 0};
    clip_to_region(square(1, {}, {0, 1, 0}), square(0.5, {0, 0.1, 0}, {0, -1, 0}), true, 0, 0.05, none);
    clip_to_region(square(1, {}, {0, 1, 0}), square(0.5, {2, 0, 0}, {0, -1, 0}), true, 0, 0.05, none);
    EXPECT_TRUE(none.points.empty());
    std::vector<Manifold> manifolds;
    append_manifolds(none, Mat3::identity(), {}, manifolds);
    EXPECT_TRUE(manifolds.empty());
}

TEST(ContactRegion, BecomesManifoldsInTheWorld) {
    Random random(3);
    const Quat rotation = random_rotation(random);
    ContactRegion region;
    region.normal = {0, 1, 0};
    clip_to_region(square(1, {}, {0, 1, 0}), square(0.5, {0.2, -0.01, 0}, {0, -1, 0}), true, 0, 0.05, region);
    const Vec3 first = region.points[0].position;
    std::vector<Manifold> manifolds;
    append_manifolds(region, to_matrix(rotation), {5, 6, 7}, manifolds);
    ASSERT_EQ(manifolds.size(), 1u);
    EXPECT_EQ(manifolds[0].count, 4);
    EXPECT_LE(manifolds[0].count, Manifold::max_points);
    EXPECT_LT(length(manifolds[0].normal - rotate(rotation, {0, 1, 0})), 1e-12);
    double nearest = 1e300;
    for (const ManifoldPoint& point : manifolds[0].points) {
        nearest = std::min(nearest, length(point.position - (Vec3{5, 6, 7} + rotate(rotation, first))));
    }
    EXPECT_LT(nearest, 1e-12);
}

TEST(ContactRegion, CrossedSegmentsMeetAtOnePointAndParallelOnesAtTwo) {
    ContactFeature a, b;
    a.points = {{-1, 0, 0}, {1, 0, 0}};
    b.points = {{0.3, 0.5, -1}, {0.3, 0.5, 1}};
    ContactRegion region;
    region.normal = {0, 1, 0};
    cross_segments(a, b, 0.2, 0.25, 0.1, region);
    ASSERT_EQ(region.points.size(), 1u);
    EXPECT_NEAR(region.points[0].separation, 0.05, 1e-12);
    EXPECT_NEAR(region.points[0].position.x, 0.3, 1e-12);
    b.points = {{0.5, 0.5, 0}, {3, 0.5, 0}};
    region.points.clear();
    cross_segments(a, b, 0.2, 0.25, 0.1, region);
    ASSERT_EQ(region.points.size(), 2u);
    for (const ManifoldPoint& point : region.points) {
        EXPECT_TRUE(std::fabs(point.position.x - 0.5) < 1e-9 || std::fabs(point.position.x - 1) < 1e-9);
    }
}

TEST(BoxPair, StacksOnFourCorners) {
    const auto box = make_shape(BoxShape{{0.5, 0.5, 0.5}});
    const auto meet = [&](Vec3 displacement, double margin, Manifold& manifold) {
        const ConvexPair pair(convex_of(*box), Mat3::identity(), convex_of(*box), Mat3::identity(), displacement);
        PairMemory memory;
        return collide_boxes(pair, margin, memory, manifold);
    };
    Manifold manifold;
    EXPECT_EQ(meet({0, 2, 0}, 0.1, manifold), BoxMeeting::none);
    ASSERT_EQ(meet({0.3, 0.99, 0.2}, 0.1, manifold), BoxMeeting::region);
    EXPECT_EQ(manifold.count, 4);
    EXPECT_LT(length(manifold.normal - Vec3{0, 1, 0}), 1e-12);
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(manifold.points[static_cast<std::size_t>(i)].separation, -0.01, 1e-9);
        EXPECT_GE(manifold.points[static_cast<std::size_t>(i)].position.x, -0.2 - 1e-6);
        EXPECT_LE(manifold.points[static_cast<std::size_t>(i)].position.x, 0.5 + 1e-6);
    }
}

TEST(CurveCrossing, OfTwoCapsulesIsWhereTheirAxesPass) {
    Random random(4);
    const auto capsule = make_shape(CapsuleShape{0.1, 1});
    for (int trial = 0; trial < 50; ++trial) {
        // One along Y, the other turned about X by an angle and moved along Z's normal.
        const double angle = random.between(0.5, 2.5);
        const Vec3 displacement{0.3, random.between(-0.4, 0.4), random.between(-0.4, 0.4)};
        CurveCrossing crossing;
        ASSERT_TRUE(cross_curves(placed(*capsule, {}, {}),
                                 placed(*capsule, from_axis_angle({1, 0, 0}, angle), displacement), {1, 0, 0},
                                 crossing));
        ASSERT_TRUE(crossing.is_within);
        EXPECT_NEAR(std::fabs(crossing.normal.x), 1, 1e-6);
        EXPECT_NEAR(crossing.on_b.x - crossing.on_a.x, 0.3, 1e-6);
        EXPECT_NEAR(crossing.on_a.z, 0, 1e-6);
        EXPECT_LT(length(crossing.on_b - crossing.on_a - Vec3{0.3, 0, 0}), 1e-6);
    }
}

TEST(DiscRegion, OfTwoCapsIsTheSmallerOne) {
    const auto wide = make_shape(CylinderShape{1, 0.5}), narrow = make_shape(CylinderShape{0.4, 0.5});
    ContactFeature reference, incident;
    ASSERT_TRUE(get_aligned_face(placed(*wide, {}, {}), {0, 1, 0}, reference));
    ASSERT_TRUE(get_aligned_face(placed(*narrow, {}, {0.2, 1.01, 0}), {0, -1, 0}, incident));
    EXPECT_EQ(reference.points.size(), static_cast<std::size_t>(rim_corners));
    EXPECT_EQ(reference.radius, 1);
    ContactRegion region;
    region.normal = {0, 1, 0};
    ASSERT_TRUE(add_disc_region(reference, incident, true, 0.05, region));
    ASSERT_GE(region.points.size(), 3u);
    for (const ManifoldPoint& point : region.points) {
        EXPECT_NEAR(point.separation, 0.01, 1e-9);
        EXPECT_NEAR(std::hypot(point.position.x - 0.2, point.position.z), 0.4, 1e-6);
    }
    thin_out_cap(reference, incident);
    EXPECT_EQ(incident.points.size(), 4u);
}

TEST(RoundFeatures, AreWhatFacesADirection) {
    const auto box = make_shape(BoxShape{{1, 2, 3}}), ball = make_shape(SphereShape{1}),
               cylinder = make_shape(CylinderShape{1, 2});
    ContactFeature feature;
    EXPECT_TRUE(get_aligned_face(placed(*box, {}, {5, 0, 0}), {1, 0, 0}, feature));
    EXPECT_EQ(feature.points.size(), 4u);
    for (const Vec3 p : feature.points) EXPECT_NEAR(p.x, 6, 1e-12);
    EXPECT_FALSE(get_aligned_face(placed(*box, {}, {}), normalized(Vec3{1, 1, 0}), feature));
    EXPECT_TRUE(has_aligned_face(placed(*box, {}, {}), normalized(Vec3{1, 0.01, 0}), 0.99));
    EXPECT_FALSE(has_aligned_face(placed(*ball, {}, {}), {1, 0, 0}, 0.5));
    feature.clear();
    EXPECT_TRUE(get_aligned_line(placed(*cylinder, {}, {}), {1, 0, 0}, feature));
    ASSERT_EQ(feature.points.size(), 2u);
    for (const Vec3 p : feature.points) EXPECT_NEAR(std::fabs(p.y), 2, 1e-12);
    std::vector<Vec3> normals;
    add_own_normals(placed(*box, {}, {}), {1, 0, 0}, true, normals);
    EXPECT_FALSE(normals.empty());
    for (const Vec3 n : normals) EXPECT_NEAR(length(n), 1, 1e-12);
    // The nearest of a face to a point beside it, and a corner for a slanting direction.
    EXPECT_LT(length(facing_point(placed(*box, {}, {}), {1, 0, 0}, {9, 0.5, 1}) - Vec3{1, 0.5, 1}), 1e-9);
    EXPECT_LT(length(facing_point(placed(*box, {}, {}), normalized(Vec3{1, 1, 1}), {}) - Vec3{1, 2, 3}), 1e-9);
}

TEST(ConvexPairs, ABallMeetsABoxAtItsNearestPoint) {
    Random random(5);
    const auto ball = make_shape(SphereShape{0.3}), box = make_shape(BoxShape{{0.5, 0.4, 0.6}});
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 displacement = any_point(random, 1.2);
        const double gap = distance_from_surface(convex_of(*box), -displacement).distance - 0.3;
        PairMemory memory;
        ContactRegion region;
        collide_sphere(placed(*ball, {}, {}), placed(*box, {}, displacement), 0.1, memory, region);
        ASSERT_EQ(region.points.size(), gap <= 0.1 ? 1u : 0u);
        if (region.points.empty()) continue;
        EXPECT_NEAR(region.points[0].separation, gap, 1e-9);
        EXPECT_LT(dot(region.normal, displacement), length(displacement) + 1e-9);
    }
}

TEST(ConvexPairs, APlaneMeetsTheLowestCorners) {
    Random random(6);
    const auto box = make_shape(BoxShape{{0.5, 0.4, 0.6}});
    for (int trial = 0; trial < 100; ++trial) {
        const PlacedConvex tilted = placed(*box, random_rotation(random), {});
        double lowest = 1e300;
        for (const Vec3 corner : corner_points({0.5, 0.4, 0.6})) lowest = std::min(lowest, tilted.to_frame(corner).y);
        ContactRegion region;
        collide_plane(tilted, {{0, 1, 0}, lowest - 0.02}, 0.05, region);
        ASSERT_FALSE(region.points.empty());
        double least = 1e300;
        for (const ManifoldPoint& point : region.points) least = std::min(least, point.separation);
        EXPECT_NEAR(least, 0.02, 1e-9);
        EXPECT_LT(length(region.normal - Vec3{0, -1, 0}), 1e-12);
    }
}

HeightfieldShape hills(Random& random) {
    HeightfieldShape field{.columns = 9, .rows = 7, .cell_x = 0.5, .cell_z = 0.4};
    for (int i = 0; i < 63; ++i) field.heights.push_back(static_cast<float>(random.between(0, 0.6)));
    return field;
}

TEST(TriangleSurface, FindsWhatALoopFinds) {
    Random random(7);
    const TriangleSurface field(hills(random));
    EXPECT_EQ(field.count(), 2u * 8 * 6);
    MeshShape mesh;
    for (std::uint32_t i = 0; i < field.count(); ++i) {
        const auto corners = field.corners(i);
        for (const Vec3 corner : corners) mesh.positions.push_back(to_vec3f(corner));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        EXPECT_NEAR(length(field.normal(i)), 1, 1e-9);
        EXPECT_GT(field.normal(i).y, 0);
    }
    const TriangleSurface loose(mesh);
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 center{random.between(-0.5, 4.5), random.between(-0.2, 0.8), random.between(-0.5, 3)};
        const Bounds box = enlarged(Bounds{center, center}, random.between(0.01, 0.5));
        for (const TriangleSurface* surface : {&field, &loose}) {
            std::vector<std::uint32_t> found;
            surface->find(box, found);
            std::ranges::sort(found);
            EXPECT_TRUE(std::ranges::adjacent_find(found) == found.end());
            for (std::uint32_t i = 0; i < surface->count(); ++i) {
                Bounds own;
                for (const Vec3 corner : surface->corners(i)) own.add(corner);
                EXPECT_TRUE(!overlaps(own, box) || std::ranges::binary_search(found, i));
            }
        }
        // Triangles near a point: none is left out that is nearer than the reach.
        const double reach = random.between(0.05, 0.5);
        std::vector<std::uint32_t> all(loose.count());
        for (std::uint32_t i = 0; i < loose.count(); ++i) all[i] = i;
        std::vector<NearTriangle> near;
        find_near_triangles(loose, all, center, reach, near);
        for (std::uint32_t i = 0; i < loose.count(); ++i) {
            PlacedTriangle t;
            t.corners = loose.corners(i);
            t.normal = loose.normal(i);
            for (std::size_t edge = 0; edge < 3; ++edge) t.outward[edge] = normalized(cross(t.along(edge), t.normal));
            const double distance = length(center - t.nearest_to(center));
            const auto listed = std::ranges::find(near, i, &NearTriangle::index);
            ASSERT_TRUE(distance >= reach || listed != near.end());
            EXPECT_NEAR(listed == near.end() ? distance : length(listed->away), distance, 1e-4);
        }
    }
}

TEST(PlacedTriangle, NearestPointIsThatOfATrial) {
    Random random(8);
    for (int trial = 0; trial < 100; ++trial) {
        PlacedTriangle t;
        for (Vec3& corner : t.corners) corner = any_point(random, 1);
        t.normal = normalized(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
        for (std::size_t edge = 0; edge < 3; ++edge) t.outward[edge] = normalized(cross(t.along(edge), t.normal));
        const Vec3 p = any_point(random, 2);
        double best = 1e300;
        constexpr int parts = 80;
        for (int i = 0; i <= parts; ++i) {
            for (int j = 0; j <= parts - i; ++j) {
                const Vec3 q = t.corners[0] + (t.corners[1] - t.corners[0]) * (i / double{parts}) +
                               (t.corners[2] - t.corners[0]) * (j / double{parts});
                best = std::min(best, length(p - q));
            }
        }
        const double found = length(p - t.nearest_to(p));
        EXPECT_LE(found, best + 1e-9);
        EXPECT_GE(found, best - 0.05);
        for (std::size_t edge = 0; edge < 3; ++edge) EXPECT_LE(t.beyond(edge, t.nearest_to(p)), 1e-9);
        EXPECT_TRUE(t.is_flat_to(t.normal));
        EXPECT_FALSE(t.is_flat_to(t.outward[0]));
    }
}

TEST(SurfacePair, ABoxOnAMeshStandsOnItsFourCorners) {
    const auto box = make_shape(BoxShape{{0.3, 0.2, 0.3}});
    const TriangleSurface floor(flat_mesh(4, 0.5, {-1, 0, -1}));
    const Transform here{};
    std::vector<Manifold> manifolds;
    collide_surface(box->data().pieces.front(), 0, {{0.05, 0.199, 0.02}, {}}, {floor, here}, 0.02, manifolds);
    std::vector<ManifoldPoint> points;
    for (const Manifold& manifold : manifolds) {
        EXPECT_LT(length(manifold.normal - Vec3{0, -1, 0}), 1e-9);
        points.insert(points.end(), manifold.points.begin(), manifold.points.begin() + manifold.count);
    }
    double low_x = 1e300, high_x = -1e300;
    for (const ManifoldPoint& point : points) {
        EXPECT_NEAR(point.separation, -0.001, 1e-6);
        low_x = std::min(low_x, point.position.x);
        high_x = std::max(high_x, point.position.x);
    }
    EXPECT_NEAR(low_x, -0.25, 1e-6);
    EXPECT_NEAR(high_x, 0.35, 1e-6);
    manifolds.clear();
    collide_surface(box->data().pieces.front(), 0, {{0, 0.3, 0}, {}}, {floor, here}, 0.02, manifolds);
    EXPECT_TRUE(manifolds.empty());
}

TEST(TrianglePairs, ABallOverATriangleHasItsHeight) {
    const auto ball = make_shape(SphereShape{0.3});
    PlacedTriangle t;
    t.corners = {Vec3{-1, -0.31, -1}, Vec3{-1, -0.31, 2}, Vec3{2, -0.31, -1}};
    t.normal = {0, 1, 0};
    for (std::size_t edge = 0; edge < 3; ++edge) t.outward[edge] = normalized(cross(t.along(edge), t.normal));
    t.half_dihedrals = {1, 1, 1};
    t.lowest = {0, -0.3, 0};
    t.height = 0.01;
    ContactRegion region;
    collide_round_triangle(convex_of(*ball), t, 0.05, region);
    ASSERT_EQ(region.points.size(), 1u);
    EXPECT_NEAR(region.points[0].separation, 0.01, 1e-9);
    EXPECT_LT(length(region.normal - Vec3{0, -1, 0}), 1e-9);
    const auto box = make_shape(BoxShape{{0.3, 0.3, 0.3}});
    ContactRegion stands;
    EXPECT_TRUE(collide_polytope_triangle(convex_of(*box), t, 0.05, stands));
    EXPECT_EQ(stands.points.size(), 4u);
}

}  // namespace
}  // namespace embody::physics::collision
