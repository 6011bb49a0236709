// SPDX-License-Identifier: MIT
// The same drawing from 1 mm to 10 km, and far from the origin: relative errors stay those of doubles.
#include <gtest/gtest.h>

#include <string>

#include "physics/collision/collision_probe.h"

namespace embody::physics::collision {
namespace {

std::vector<ShapeDefinition> sized(double s) {
    std::vector<Vec3> points = corner_points({0.3 * s, 0.5 * s, 0.4 * s});
    return {SphereShape{0.5 * s},           BoxShape{{0.3 * s, 0.5 * s, 0.4 * s}},
            CapsuleShape{0.2 * s, 0.3 * s}, CylinderShape{0.4 * s, 0.5 * s},
            ConeShape{0.4 * s, 0.5 * s},    HullShape{points}};
}

TEST(Extremes, every_size_stands_on_every_size) {
    for (const double size : {1e-3, 1.0, 1e3, 1e4}) {
        for (const double ground_size : {1e-3, 1.0, 1e4}) {
            const double lesser = std::min(size, ground_size);
            for (const ShapeDefinition& upper : sized(size)) {
                for (const ShapeDefinition& lower : sized(ground_size)) {
                    if (std::holds_alternative<ConeShape>(lower)) continue;  // its tip is no ground
                    SCOPED_TRACE(std::string(shape_name(upper)) + " of " + std::to_string(size) + " on " +
                                 shape_name(lower) + " of " + std::to_string(ground_size));
                    const auto a = make_shape(lower), b = make_shape(upper);
                    for (const double relative_gap : {-0.01, 0.005}) {
                        const double gap = relative_gap * lesser;
                        const double height = a->local_bounds().upper.y - b->local_bounds().lower.y + gap;
                        const auto manifolds = contacts(*a, {}, *b, {{0, height, 0}, {}}, 0.02 * lesser);
                        ASSERT_EQ(manifolds.size(), 1u);
                        EXPECT_LT(distance(manifolds[0].normal, {0, 1, 0}), 1e-6);
                        EXPECT_NEAR(deepest(manifolds), gap, 1e-4 * lesser);
                    }
                }
            }
        }
    }
}

TEST(Extremes, ten_kilometres_from_the_origin_nothing_changes) {
    const Vec3 far{1e4, -1e4, 1e4};
    for (const ShapeDefinition& first : sized(1)) {
        for (const ShapeDefinition& second : sized(1)) {
            const auto a = make_shape(first), b = make_shape(second);
            const Quat turned = from_axis_angle(normalized(Vec3{1, 2, -1}), 0.7);
            const Vec3 offset{0.3, 0.6, -0.2};
            const auto near = contacts(*a, {}, *b, {offset, turned}, 0.05);
            const auto away = contacts(*a, {far, {}}, *b, {far + offset, turned}, 0.05);
            ASSERT_EQ(near.size(), away.size());
            if (near.empty()) continue;
            EXPECT_NEAR(deepest(near), deepest(away), 1e-6) << shape_name(first) << " " << shape_name(second);
        }
    }
}

TEST(Extremes, identical_poses_give_finite_contacts) {
    for (const ShapeDefinition& first : sized(1)) {
        for (const ShapeDefinition& second : sized(1)) {
            const auto a = make_shape(first), b = make_shape(second);
            const auto manifolds = contacts(*a, {}, *b, {}, 0);
            ASSERT_EQ(manifolds.size(), 1u) << shape_name(first) << " " << shape_name(second);
            EXPECT_NEAR(length(manifolds[0].normal), 1, 1e-9);
            EXPECT_LT(deepest(manifolds), -0.2);
            EXPECT_GT(deepest(manifolds), -1.6);
        }
    }
}

// A hull built of many round points: GJK, EPA and the clipping of many sides.
TEST(Extremes, a_hull_of_all_vertices_it_may_have_rests_on_itself) {
    Random random(4);
    HullShape ball;
    for (int i = 0; i < 2000; ++i) ball.points.push_back(random_direction(random));
    const auto hull = make_shape(ball);
    for (int trial = 0; trial < 20; ++trial) {
        const Transform pose{random_direction(random) * 1.98, random_rotation(random)};
        const auto manifolds = contacts(*hull, {}, *hull, pose, 0.05);
        ASSERT_EQ(manifolds.size(), 1u);
        EXPECT_NEAR(deepest(manifolds), -0.01, 0.03);
        EXPECT_GT(dot(manifolds[0].normal, normalized(pose.position)), 0.97);
    }
}

}  // namespace
}  // namespace embody::physics::collision
