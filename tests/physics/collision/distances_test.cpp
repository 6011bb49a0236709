// SPDX-License-Identifier: MIT
// Distances, rays and directions of single convexes against formulas and plain loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/collision/collision_probe.h"
#include "physics/collision/pairs/convex_pair.h"
#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/parting_axis.h"
#include "physics/collision/queries/ball_touch.h"
#include "physics/collision/queries/cast_at_convex.h"
#include "physics/collision/queries/gjk.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/collision/shapes/convex.h"
#include "physics/collision/shapes/polytope_query.h"
#include "physics/collision/shapes/rim.h"

namespace embody::physics::collision {
namespace {

constexpr double pi = 3.14159265358979323846;

Vec3 any_point(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

const Convex& convex_of(const CollisionShape& shape) { return shape.data().pieces.front().convex; }

std::vector<std::unique_ptr<CollisionShape>> convexes(Random& random) {
    std::vector<std::unique_ptr<CollisionShape>> shapes;
    shapes.push_back(make_shape(SphereShape{0.4}));
    shapes.push_back(make_shape(BoxShape{{0.3, 0.5, 0.2}}));
    shapes.push_back(make_shape(CapsuleShape{0.2, 0.4}));
    shapes.push_back(make_shape(CylinderShape{0.3, 0.4}));
    shapes.push_back(make_shape(ConeShape{0.4, 0.5}));
    HullShape hull;
    for (int i = 0; i < 30; ++i) hull.points.push_back(any_point(random, 0.5));
    shapes.push_back(make_shape(hull));
    return shapes;
}

PlacedConvex placed(const Convex& convex, Quat rotation, Vec3 position) {
    return {&convex, to_matrix(rotation), position};
}

TEST(CoreDistance, OfBallsIsThatOfTheirCentres) {
    Random random(1);
    const auto a = make_shape(SphereShape{0.3}), b = make_shape(SphereShape{0.5});
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 displacement = any_point(random, 2);
        const CoreDistance found =
            core_distance(Core(placed(convex_of(*a), {}, {})), Core(placed(convex_of(*b), {}, displacement)));
        // A ball's core is its centre.
        EXPECT_NEAR(found.distance, length(displacement), 1e-9);
        EXPECT_LT(length(found.on_b - displacement), 1e-9);
    }
}

// No direction tells a larger gap than the distance, the best one tells it, and the nearest points are so far apart.
TEST(CoreDistance, IsTheLargestGapOfAllDirections) {
    Random random(2);
    const auto shapes = convexes(random);
    int apart = 0, overlapping = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const Convex &first = convex_of(*shapes[random.below(shapes.size())]),
                     &second = convex_of(*shapes[random.below(shapes.size())]);
        const Core a(placed(first, random_rotation(random), {})),
            b(placed(second, random_rotation(random), any_point(random, 1)));
        const CoreDistance found = core_distance(a, b);
        const auto gap_along = [&](Vec3 n) { return dot(b.support(-n), n) - dot(a.support(n), n); };
        double best = -1e300;
        for (int i = 0; i < 60; ++i) best = std::max(best, gap_along(random_direction(random)));
        if (found.overlap) {
            EXPECT_LE(best, 1e-9);
            ++overlapping;
            continue;
        }
        ++apart;
        EXPECT_GE(found.distance, best - 1e-9);
        EXPECT_NEAR(length(found.on_b - found.on_a), found.distance, 1e-6);
        const Vec3 normal = normalized(found.on_b - found.on_a);
        EXPECT_NEAR(gap_along(normal), found.distance, 1e-6);
        // A direction that tells enough is as good.
        const CoreDistance early = core_distance(a, b, 0.1 * found.distance);
        EXPECT_LE(early.distance, found.distance + 1e-9);
        EXPECT_GE(early.distance, 0.1 * found.distance);
    }
    EXPECT_GT(apart, 100);
    EXPECT_GT(overlapping, 50);
}

TEST(CoreDistance, OverlappingBoxesSeparateAlongTheirMinimumDepth) {
    Random random(3);
    const auto box = make_shape(BoxShape{{0.5, 0.5, 0.5}});
    for (int trial = 0; trial < 100; ++trial) {
        Vec3 displacement = any_point(random, 0.4);
        const int axis = static_cast<int>(random.below(3));
        displacement[axis] = random.unit() < 0.5 ? -0.9 : 0.9;
        const Core a(placed(convex_of(*box), {}, {})), b(placed(convex_of(*box), {}, displacement));
        const CoreDistance found = core_distance(a, b);
        ASSERT_TRUE(found.overlap);
        Vec3 normal;
        ASSERT_TRUE(penetration_normal(a, b, found, normal));
        EXPECT_NEAR(normal[axis], displacement[axis] > 0 ? 1 : -1, 1e-6);
    }
}

TEST(PartingAxis, TellsTheSeparationAlongIt) {
    Random random(4);
    const auto shapes = convexes(random);
    int found_any = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Convex& a = convex_of(*shapes[random.below(shapes.size())]);
        const Convex& b = convex_of(*shapes[2 * random.below(3)]);  // a ball, capsule or cone
        const PlacedConvex first = placed(a, random_rotation(random), {}),
                           second = placed(b, random_rotation(random), any_point(random, 1));
        EXPECT_GT(smaller_size(first, second), 0.5);
        PairMemory memory;
        constexpr double margin = 0.3;
        const PartingAxis axis = find_parting_axis(first, second, margin, memory);
        double best = -1e300;
        for (int i = 0; i < 60; ++i) best = std::max(best, separation_along(first, second, random_direction(random)));
        if (!axis.found) {
            const double gap = core_distance(Core(first), Core(second)).distance - rounding(a) - rounding(b);
            EXPECT_GT(gap, margin - 1e-6);
            continue;
        }
        ++found_any;
        EXPECT_NEAR(length(axis.normal), 1, 1e-9);
        EXPECT_NEAR(separation_along(first, second, axis.normal), axis.separation, 1e-6);
        EXPECT_GE(axis.separation, best - 1e-3);
    }
    EXPECT_GT(found_any, 100);
}

TEST(SurfaceDistance, IsTheFormulasOfRoundOnesAndBoxes) {
    Random random(5);
    const auto shapes = convexes(random);
    for (int trial = 0; trial < 300; ++trial) {
        const Vec3 p = any_point(random, 1);
        const double radial = std::hypot(p.x, p.z);
        EXPECT_NEAR(distance_from_surface(convex_of(*shapes[0]), p).distance, length(p) - 0.4, 1e-9);
        const double capsule = length(p - Vec3{0, std::clamp(p.y, -0.4, 0.4), 0}) - 0.2;
        EXPECT_NEAR(distance_from_surface(convex_of(*shapes[2]), p).distance, capsule, 1e-9);
        const double side = radial - 0.3, top = std::fabs(p.y) - 0.4;
        const double cylinder =
            std::hypot(std::max(side, 0.0), std::max(top, 0.0)) + std::min(std::max(side, top), 0.0);
        EXPECT_NEAR(distance_from_surface(convex_of(*shapes[3]), p).distance, cylinder, 1e-9);
        const Vec3 out = abs(p) - Vec3{0.3, 0.5, 0.2}, beyond = max(out, {});
        const double box = length(beyond) + std::min(std::max({out.x, out.y, out.z}), 0.0);
        EXPECT_NEAR(distance_from_surface(convex_of(*shapes[1]), p).distance, box, 1e-9);
        for (const auto& shape : shapes) {
            const SurfaceDistance found = distance_from_surface(convex_of(*shape), p);
            EXPECT_NEAR(length(found.normal), 1, 1e-9);
            // A step towards the surface ends on it.
            const Vec3 foot = p - found.normal * found.distance;
            EXPECT_NEAR(distance_from_surface(convex_of(*shape), foot).distance, 0, 1e-6);
        }
    }
}

TEST(RayAtConvex, MeetsBallsAndBoxesWhereTheFormulaSays) {
    Random random(6);
    const auto ball = make_shape(SphereShape{0.4}), box = make_shape(BoxShape{{0.3, 0.5, 0.2}});
    int hits = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 origin = any_point(random, 1.5);
        const Vec3 direction = normalized(any_point(random, 0.5) - origin);
        const double along = -dot(origin, direction);
        const double missed = std::sqrt(std::max(0.0, length_squared(origin) - along * along));
        const auto hit = cast_ray(convex_of(*ball), origin, direction, 10);
        const bool is_met = length(origin) > 0.4 && along > 0 && missed < 0.4;
        ASSERT_EQ(hit.has_value(), is_met);
        if (hit) {
            const double exact = along - std::sqrt(0.16 - missed * missed);
            EXPECT_NEAR(hit->distance, exact, 1e-9);
            EXPECT_LT(length(hit->normal - (origin + direction * exact) / 0.4), 1e-6);
            EXPECT_FALSE(cast_ray(convex_of(*ball), origin, direction, 0.999 * exact));
        }
        double enter = -1e300, leave = 1e300;
        for (int k = 0; k < 3; ++k) {
            const double half = k == 0 ? 0.3 : k == 1 ? 0.5 : 0.2;
            const double a = (-half - origin[k]) / direction[k], b = (half - origin[k]) / direction[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        const auto at_box = cast_ray(convex_of(*box), origin, direction, 10);
        ASSERT_EQ(at_box.has_value(), enter > 0 && enter < leave);
        if (at_box) {
            EXPECT_NEAR(at_box->distance, enter, 1e-9);
            ++hits;
        }
    }
    EXPECT_GT(hits, 100);
}

// Where a ray meets anything it comes to the surface, from outside, against the normal; nothing is on its way there.
TEST(RayAtConvex, EndsOnTheSurface) {
    Random random(7);
    const auto shapes = convexes(random);
    int hits = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const Convex& convex = convex_of(*shapes[random.below(shapes.size())]);
        const Vec3 origin = any_point(random, 1.5), direction = normalized(any_point(random, 0.4) - origin);
        const double start = distance_from_surface(convex, origin).distance;
        const auto hit = cast_ray(convex, origin, direction, 10);
        if (start < 0) {
            EXPECT_FALSE(hit);
            continue;
        }
        const double displacement = hit ? hit->distance : 4;
        for (int i = 1; i < 20; ++i) {
            const Vec3 p = origin + direction * (displacement * i / 20);
            EXPECT_GT(distance_from_surface(convex, p).distance, -1e-9);
        }
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(distance_from_surface(convex, origin + direction * displacement).distance, 0, 1e-7);
        EXPECT_LT(dot(hit->normal, direction), 1e-9);
    }
    EXPECT_GT(hits, 200);
}

TEST(BallTouches, KnowTheGapToTheGround) {
    Random random(8);
    const auto ball = make_shape(SphereShape{0.1}), plane = make_shape(PlaneShape{}),
               globe = make_shape(SphereShape{2});
    std::vector<BallTouch> touches;
    find_ball_touches(*ball, 0.1, {3, 0.11, 4}, *plane, {}, 0.05, touches);
    ASSERT_EQ(touches.size(), 1u);
    EXPECT_NEAR(touches[0].gap, 0.01, 1e-12);
    EXPECT_TRUE(touches[0].is_flat);
    EXPECT_LT(length(touches[0].normal - Vec3{0, 1, 0}), 1e-12);
    touches.clear();
    find_ball_touches(*ball, 0.1, {3, 0.3, 4}, *plane, {}, 0.05, touches);
    EXPECT_TRUE(touches.empty());
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 out = random_direction(random), middle = any_point(random, 5);
        touches.clear();
        find_ball_touches(*ball, 0.1, middle + out * 2.08, *globe, {middle, random_rotation(random)}, 0.05, touches);
        ASSERT_EQ(touches.size(), 1u);
        EXPECT_NEAR(touches[0].gap, -0.02, 1e-9);
        EXPECT_FALSE(touches[0].is_flat);
        EXPECT_LT(length(touches[0].normal - out), 1e-9);
        EXPECT_FALSE(touches[0].knows_curvature);  // that is for what approximates a smooth surface
    }
}

TEST(PolytopeQuery, FindsWhatAPlainLoopFinds) {
    Random random(9);
    const Lanes none;
    EXPECT_EQ(farthest(none, {1, 0, 0}).along, -1e300);
    for (int trial = 0; trial < 60; ++trial) {
        HullShape hull;
        for (int i = 0; i < 12 + trial; ++i) hull.points.push_back(any_point(random, 1));
        const auto shape = make_shape(hull);
        const Polytope& polytope = convex_of(*shape).polytope;
        const Vec3 direction = any_point(random, 1), point = any_point(random, 1.5);
        double least = 1e300, most = -1e300;
        std::uint32_t first = 0;
        for (std::uint32_t i = 0; i < polytope.vertices.size(); ++i) {
            const double here = dot(polytope.vertices[i], direction);
            if (here > most) first = i;
            least = std::min(least, here);
            most = std::max(most, here);
        }
        const Extreme found = farthest(polytope.vertex_lanes, direction);
        EXPECT_NEAR(found.along, most, 1e-12);
        EXPECT_EQ(found.index, first);
        EXPECT_EQ(support_vertex(polytope, direction), first);
        const Extent both = extent(polytope.vertex_lanes, direction);
        EXPECT_NEAR(both.lowest, least, 1e-12);
        EXPECT_NEAR(both.highest, most, 1e-12);
        const std::uint32_t rough = farthest_roughly(polytope.rough_vertex_lanes, direction);
        EXPECT_NEAR(dot(polytope.vertices[rough], direction), most, 1e-5);
        std::vector<double> heights(polytope.normal_lanes.size());
        const double highest = heights_over_faces(polytope, point, heights.data());
        double wanted = -1e300;
        for (std::size_t i = 0; i < polytope.faces.size(); ++i) {
            const double height = dot(polytope.faces[i].normal, point) - polytope.faces[i].offset;
            EXPECT_NEAR(heights[i], height, 1e-9);
            wanted = std::max(wanted, height);
        }
        EXPECT_NEAR(highest, wanted, 1e-9);
        std::vector<std::uint32_t> low(polytope.vertex_lanes.size());
        const double limit = least + 0.3 * (most - least);
        const std::uint32_t count = find_low(polytope.vertex_lanes, direction, limit, low.data());
        std::vector<std::uint32_t> listed;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (low[i] < polytope.vertices.size()) listed.push_back(low[i]);
        }
        std::vector<std::uint32_t> loop;
        for (std::uint32_t i = 0; i < polytope.vertices.size(); ++i) {
            if (dot(polytope.vertices[i], direction) <= limit) loop.push_back(i);
        }
        EXPECT_EQ(listed, loop);
    }
}

TEST(Rims, BeginAtTheirFarthestPoint) {
    Random random(10);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 direction = random_direction(random);
        const RimStart start = rim_start(direction);
        EXPECT_NEAR(length(start.along), 1, 1e-9);
        EXPECT_NEAR(length(start.across), 1, 1e-9);
        EXPECT_NEAR(dot(start.along, start.across), 0, 1e-9);
        EXPECT_EQ(start.along.y, 0);
        for (double angle = 0; angle < 2 * pi; angle += 0.1) {
            const Vec3 other = start.along * std::cos(angle) + start.across * std::sin(angle);
            EXPECT_LE(dot(other, direction), dot(start.along, direction) + 1e-9);
        }
    }
    EXPECT_EQ(rim_start({0, 1, 0}).along, (Vec3{1, 0, 0}));
}

TEST(ConvexPair, IsSeenFromTheFirst) {
    Random random(12);
    const auto shapes = convexes(random);
    for (int trial = 0; trial < 50; ++trial) {
        const Quat first = random_rotation(random), second = random_rotation(random);
        const Vec3 displacement = any_point(random, 3), p = any_point(random, 1);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(length(turn_of(first).column(c) - to_matrix(first).column(c)), 1e-12);
        }
        const ConvexPair pair(convex_of(*shapes[0]), turn_of(first), convex_of(*shapes[1]), turn_of(second),
                              displacement);
        // A point of the second in the world, seen from the first.
        const Vec3 world = displacement + rotate(second, p);
        EXPECT_LT(length(pair.placed_b().to_frame(p) - rotate_inverse(first, world)), 1e-12);
        EXPECT_LT(length(pair.placed_b().to_local(pair.placed_b().to_frame(p)) - p), 1e-12);
    }
}

}  // namespace
}  // namespace embody::physics::collision
