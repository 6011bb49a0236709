// SPDX-License-Identifier: MIT
#include "geometry/bounding_volume_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "foundation/random.h"
#include "geometry/sample_meshes.h"

namespace embody::geometry {
namespace {

Vec3 random_point(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
std::vector<Bounds> random_boxes(Random& random, std::size_t count) {
    std::vector<Bounds> boxes(count);
    for (Bounds& box : boxes) {
        const Vec3 center = random_point(random, 10);
        box.add(center);
        box.add(center + random_point(random, std::pow(10, random.between(-3, 0.5))));
    }
    return boxes;
}
std::vector<std::uint32_t> found(const BoundingVolumeTree& tree, const Bounds& box) {
    std::vector<std::uint32_t> result;
    tree.query(box, [&](std::uint32_t leaf) { result.push_back(leaf); });
    return result;
}

TEST(BoundingVolumeTree, EmptyTreeVisitsNothing) {
    const BoundingVolumeTree tree(std::span<const Bounds>{});
    EXPECT_TRUE(tree.is_empty());
    EXPECT_TRUE(tree.bounds().is_empty());
    EXPECT_TRUE(found(tree, {{-9, -9, -9}, {9, 9, 9}}).empty());
    tree.query_ray({}, {1, 0, 0}, 9, [](std::uint32_t, double t) {
        ADD_FAILURE();
        return t;
    });
}

TEST(BoundingVolumeTree, LeavesThatAreNotFiniteAreNeverVisited) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    std::vector<Bounds> boxes(10, Bounds{{0, 0, 0}, {1, 1, 1}});
    boxes[3].lower.y = nan;
    boxes[5] = Bounds{};
    boxes[7].upper.z = inf;
    const BoundingVolumeTree tree(boxes);
    EXPECT_EQ(tree.leaf_count(), 7u);
    EXPECT_EQ(found(tree, {{-9, -9, -9}, {9, 9, 9}}).size(), 7u);
    EXPECT_TRUE(found(tree, Bounds{}).empty());
}

TEST(BoundingVolumeTree, ManyEqualBoxesAreAllFound) {
    const BoundingVolumeTree tree(std::vector<Bounds>(5000, Bounds{{1, 1, 1}, {1, 1, 1}}));
    EXPECT_EQ(found(tree, {{1, 1, 1}, {1, 1, 1}}).size(), 5000u);
}

TEST(BoundingVolumeTree, UnevenSpacingDoesNotOverflowTheDepth) {
    // Geometric spacing: almost every binned split separates a single leaf.
    std::vector<Bounds> boxes;
    for (int i = 0; i < 2000; ++i) {
        const double x = std::pow(10, -30 + 0.03 * i);
        boxes.push_back({{x, 0, 0}, {x, 1, 1}});
    }
    const BoundingVolumeTree tree(boxes);
    EXPECT_EQ(found(tree, tree.bounds()).size(), 2000u);
}

TEST(BoundingVolumeTree, BoxQueryFindsWhatASearchOfAllFinds) {
    Random random(5);
    const auto boxes = random_boxes(random, 3000);
    const BoundingVolumeTree tree(boxes);
    for (int i = 0; i < 300; ++i) {
        Bounds box;
        box.add(random_point(random, 10));
        box.add(random_point(random, 10));
        auto seen = found(tree, box);
        std::sort(seen.begin(), seen.end());
        std::vector<std::uint32_t> expected;
        for (std::uint32_t k = 0; k < boxes.size(); ++k) {
            if (overlaps(boxes[k], box)) expected.push_back(k);
        }
        // Outward rounding may add a leaf that misses by a float's last digit, but never loses one.
        EXPECT_TRUE(std::includes(seen.begin(), seen.end(), expected.begin(), expected.end()));
        EXPECT_LE(seen.size(), expected.size() + 2);
    }
}

// Möller and Trumbore 1997; the distance in units of `direction`, or infinity.
double hit(const TriangleMesh& mesh, std::uint32_t index, Vec3 origin, Vec3 direction) {
    const auto [a, b, c] = corners(mesh, index);
    const Vec3 p = cross(direction, c - a);
    const double det = dot(b - a, p);
    if (det == 0) return HUGE_VAL;
    const double u = dot(origin - a, p) / det;
    const Vec3 q = cross(origin - a, b - a);
    const double v = dot(direction, q) / det, t = dot(c - a, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? t : HUGE_VAL;
}

TEST(BoundingVolumeTree, RayFindsTheNearestTriangle) {
    Random random(7);
    const TriangleMesh mesh = make_torus(2, 0.7, 60, 40);
    const BoundingVolumeTree tree(mesh);
    int hits = 0;
    std::size_t visits = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 origin = random_point(random, 4);
        Vec3 direction = random_point(random, 1);
        if (i % 5 == 0) direction = {0, direction.y, 0};
        double expected = HUGE_VAL, nearest = HUGE_VAL;
        for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
            expected = std::min(expected, hit(mesh, k, origin, direction));
        }
        tree.query_ray(origin, direction, HUGE_VAL, [&](std::uint32_t leaf, double max_t) {
            ++visits;
            nearest = std::min(max_t, hit(mesh, leaf, origin, direction));
            return nearest;
        });
        hits += std::isfinite(expected) ? 1 : 0;
        EXPECT_EQ(nearest, expected);
    }
    EXPECT_GT(hits, 50);
    EXPECT_LT(visits, 500u * 60);
}

TEST(BoundingVolumeTree, RayStopsAtItsEndAndWhenToldTo) {
    const BoundingVolumeTree tree(std::vector<Bounds>(20, Bounds{{5, -1, -1}, {6, 1, 1}}));
    int visits = 0;
    const auto count = [&](std::uint32_t, double t) {
        ++visits;
        return t;
    };
    tree.query_ray({}, {1, 0, 0}, 4.9, count);
    EXPECT_EQ(visits, 0);
    tree.query_ray({}, {1, 0, 0}, 5.1, count);
    EXPECT_EQ(visits, 20);
    tree.query_ray({}, {-1, 0, 0}, 100, count);
    EXPECT_EQ(visits, 20);
    tree.query_ray({}, {1, 0, 0}, 100, [&](std::uint32_t, double) {
        ++visits;
        return -1.0;
    });
    EXPECT_EQ(visits, 21);
}

}  // namespace
}  // namespace embody::geometry
