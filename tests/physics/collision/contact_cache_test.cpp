// SPDX-License-Identifier: MIT
#include "physics/collision/contact_cache.h"

#include <gtest/gtest.h>

#include <map>

#include "physics/collision/collision_probe.h"

namespace embody::physics {
namespace {

CachedPoint point(std::uint32_t feature, Vec3 position, double impulse = 0) {
    CachedPoint p;
    p.feature = feature;
    p.position = position;
    p.normal_impulse = impulse;
    return p;
}

TEST(ContactCache, knows_nothing_of_strangers) {
    ContactCache cache;
    EXPECT_EQ(cache.find({1, 2}, point(5, {}), 1), nullptr);
    cache.put({1, 2}, point(5, {}, 3));
    EXPECT_EQ(cache.find({1, 2}, point(5, {}), 1), nullptr) << "found before the step ended";
    cache.turn_over();
    EXPECT_EQ(cache.find({1, 3}, point(5, {}), 1), nullptr);
    EXPECT_EQ(cache.find({1, 2}, point(6, {9, 0, 0}), 1), nullptr);
}

TEST(ContactCache, finds_by_feature_first_and_by_place_second) {
    ContactCache cache;
    cache.put({1, 2}, point(5, {0, 0, 0}, 3));
    cache.put({1, 2}, point(6, {0.01, 0, 0}, 4));
    cache.put({0, 9}, point(5, {0, 0, 0}, 7));
    cache.turn_over();
    EXPECT_EQ(cache.find({1, 2}, point(6, {5, 0, 0}), 0.02)->normal_impulse, 4);
    EXPECT_EQ(cache.find({1, 2}, point(77, {0.005, 0, 0}), 0.02)->normal_impulse, 3);
    EXPECT_EQ(cache.find({1, 2}, point(78, {0.005, 0, 0}), 0.02), nullptr) << "a point was handed out twice";
    EXPECT_EQ(cache.find({0, 9}, point(5, {}), 0.02)->normal_impulse, 7);
    cache.turn_over();
    EXPECT_EQ(cache.size(), 0u) << "the cache is built anew each step";
}

TEST(ContactCache, forgets_a_body) {
    ContactCache cache;
    cache.put({1, 2}, point(5, {}, 3));
    cache.put({2, 3}, point(5, {}, 4));
    cache.put({3, 4}, point(5, {}, 5));
    cache.turn_over();
    cache.forget(2);
    EXPECT_EQ(cache.size(), 1u);
    EXPECT_NE(cache.find({3, 4}, point(5, {}), 0), nullptr);
}

// Small motions keep the names of the points, or warm starting would find nothing.
TEST(ContactFeatures, keep_their_names_from_step_to_step) {
    const auto floor = make_shape(BoxShape{{5, 0.5, 5}});
    const ShapeDefinition shapes[] = {BoxShape{{0.3, 0.3, 0.3}}, CylinderShape{0.3, 0.3}, CapsuleShape{0.3, 0.3},
                                      ConeShape{0.3, 0.3}, HullShape{corner_points({0.3, 0.3, 0.3})}};
    for (const ShapeDefinition& definition : shapes) {
        SCOPED_TRACE(shape_name(definition));
        const auto shape = make_shape(definition);
        const double under = -shape->local_bounds().lower.y;
        std::map<std::uint32_t, int> names;
        for (int step = 0; step < 20; ++step) {
            const Transform pose{{0.1 + 1e-3 * step, 0.5 + under - 1e-3 + 1e-5 * (step % 3), 0},
                                 from_axis_angle({0, 1, 0}, 1e-3 * step)};
            const auto manifolds = contacts(*floor, {}, *shape, pose, 0.01);
            ASSERT_EQ(manifolds.size(), 1u);
            for (int i = 0; i < manifolds[0].count; ++i) {
                ++names[manifolds[0].points[static_cast<std::size_t>(i)].feature];
            }
        }
        EXPECT_LE(names.size(), 4u);
    }
}

TEST(ContactFeatures, tell_the_points_of_a_manifold_apart) {
    Random random(77);
    const auto box = make_shape(BoxShape{{0.5, 0.3, 0.4}});
    for (int trial = 0; trial < 2000; ++trial) {
        const Transform pose{random_direction(random) * 0.7, random_rotation(random)};
        for (const Manifold& m : contacts(*box, {}, *box, pose, 0.02)) {
            for (int i = 0; i < m.count; ++i) {
                for (int j = 0; j < i; ++j) {
                    EXPECT_NE(m.points[static_cast<std::size_t>(i)].feature,
                              m.points[static_cast<std::size_t>(j)].feature);
                }
            }
        }
    }
}

}  // namespace
}  // namespace embody::physics
