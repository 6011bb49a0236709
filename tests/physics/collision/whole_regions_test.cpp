// SPDX-License-Identifier: MIT
// A region says that it is whole where no other corner of two hulls is within the margin, and only there: such contacts
// follow their bodies until they have moved by Manifold::whole_travel.
#include <numbers>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

constexpr double margin = 0.0075;

/// A block with a pyramid on top: more corners than a box has, four of them below, half a metre apart.
HullShape pedestal() {
    HullShape hull{corner_points({0.25, 0.25, 0.25})};
    for (const double x : {-0.1, 0.1}) {
        hull.points.push_back({x, 0.4, 0});
        hull.points.push_back({0, 0.4, x});
    }
    return hull;
}

/// A roof along x, two metres long, whose ridge is at y = 0 and whose shoulders are `lower` below it, 2 cm beside it.
HullShape roof(double lower) {
    HullShape hull;
    for (const double x : {-1.0, 1.0}) {
        hull.points.push_back({x, 0, 0});
        for (const double side : {-1.0, 1.0}) {
            hull.points.push_back({x, -lower, 0.02 * side});
            hull.points.push_back({x, -lower - 0.5, 0.3 * side});
        }
    }
    return hull;
}

TEST(WholeRegions, a_hull_on_its_face_touches_with_each_corner_once) {
    const auto hull = make_shape(pedestal());
    const auto on = [&](const ShapeDefinition& ground) {
        return contacts(*hull, {{-1, 0.2499, 1}, {}}, *make_shape(ground), {}, margin);
    };
    const HullShape block{{{-9, 0, -9}, {-9, 0, 9}, {9, 0, -9}, {9, 0, 9}, {0, -5, 0}}};
    for (const auto& manifolds : {on(block), on(flat_mesh(1, 18, {-9, 0, -9}))}) {
        ASSERT_EQ(manifolds.size(), 1u);
        EXPECT_TRUE(manifolds[0].is_whole);
        ASSERT_EQ(manifolds[0].count, 4);
        for (const ManifoldPoint& point : manifolds[0].points) {
            EXPECT_NEAR(std::fabs(point.position.x + 1), 0.25, 1e-9);
            EXPECT_NEAR(std::fabs(point.position.z - 1), 0.25, 1e-9);
        }
    }
}

TEST(WholeRegions, a_rounded_hull_below_a_block_is_whole_only_with_all_its_high_corners) {
    Random random(4);
    HullShape ball;
    for (int i = 0; i < 200; ++i) ball.points.push_back(random_direction(random) * 0.2);
    const auto round = make_shape(ball), block = make_shape(pedestal());
    int whole = 0, partial = 0;
    for (int pose = 0; pose < 200; ++pose) {
        const Transform below{{0, -0.4498, 0}, random_rotation(random)};
        const auto manifolds = contacts(*block, {}, *round, below, margin);
        if (manifolds.size() != 1 || !manifolds[0].is_whole) {
            ++partial;
            continue;
        }
        ++whole;
        int high = 0;
        for (const Vec3& corner : ball.points) high += transform_point(below, corner).y > -0.25 - margin ? 1 : 0;
        EXPECT_EQ(manifolds[0].count, high) << "pose " << pose;
    }
    EXPECT_GT(whole, 0);
    EXPECT_GT(partial, 0);
}

TEST(WholeRegions, crossing_edges_are_whole_where_no_other_corner_is_near) {
    const Transform upside_down{
        {0, 1e-4, 0},
        from_axis_angle({1, 0, 0}, std::numbers::pi) * from_axis_angle({0, 1, 0}, 0.5 * std::numbers::pi)};
    for (const bool is_blunt : {false, true}) {
        const auto ridge = make_shape(roof(is_blunt ? 0.004 : 0.012));
        const auto manifolds = contacts(*ridge, {}, *ridge, upside_down, margin);
        ASSERT_EQ(manifolds.size(), 1u);
        EXPECT_EQ(manifolds[0].count, 1);
        EXPECT_NEAR(manifolds[0].points[0].separation, 1e-4, 1e-9);
        EXPECT_EQ(manifolds[0].is_whole, !is_blunt);
    }
}

}  // namespace
}  // namespace embody::physics::collision
