// SPDX-License-Identifier: MIT
// Thousands of random poses of every pair of convex solids against a search over all directions, and against what must
// hold of any contact whatever its shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "physics/collision/collision_probe.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/every_shape.h"

namespace embody::physics::collision {
namespace {

struct Solid {
    const char* name;
    ShapeDefinition definition;
};

std::vector<Solid> all_solids() {
    Random random(7);
    HullShape hull;
    for (int i = 0; i < 40; ++i) {
        const Vec3 d = random_direction(random);
        hull.points.push_back({0.6 * d.x, 0.4 * d.y, 0.5 * d.z});
    }
    std::vector<Solid> solids{{"sphere", SphereShape{0.4}},         {"box", BoxShape{{0.5, 0.3, 0.2}}},
                              {"capsule", CapsuleShape{0.2, 0.4}},  {"cylinder", CylinderShape{0.4, 0.3}},
                              {"cone", ConeShape{0.5, 0.4}},        {"hull", hull},
                              {"needle", CylinderShape{0.01, 0.8}}, {"tile", BoxShape{{0.6, 0.005, 0.6}}}};
    for_each_shape_of_lengths<ConvexShape>([&]<class Shape>(const Shape& shape) {
        if constexpr (HasCorners<Shape>) solids.push_back({shape.name, shape});
    });
    return solids;
}

// Largest separation over directions: a fine sample of the sphere, then closer and closer around the best of it.
double true_separation(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b,
                       const Transform& pose_b, Random& random) {
    const PlacedConvex placed_a = place(a.data().pieces[0], pose_a, pose_a.position);
    const PlacedConvex placed_b = place(b.data().pieces[0], pose_b, pose_a.position);
    struct Candidate {
        double separation;
        Vec3 direction;
    };
    std::vector<Candidate> best;
    for (int i = 0; i < 600; ++i) {
        const Vec3 d = random_direction(random);
        best.push_back({separation_along(placed_a, placed_b, d), d});
    }
    std::sort(best.begin(), best.end(), [](const auto& x, const auto& y) { return x.separation > y.separation; });
    best.resize(8);
    double highest = -HUGE_VAL;
    for (Candidate& c : best) {
        double radius = 0.2;
        for (int i = 0; i < 400; ++i) {
            const Vec3 d = normalized(c.direction + random_direction(random) * (radius * random.unit()));
            const double s = separation_along(placed_a, placed_b, d);
            if (s > c.separation) {
                c = {s, d};
            } else {
                radius = std::max(radius * 0.96, 1e-7);
            }
        }
        highest = std::max(highest, c.separation);
    }
    return highest;
}

struct PosedPair {
    Transform a, b;
};

PosedPair random_pair(Random& random) {
    const double apart = random.between(0.05, 1.3);
    return {{random_direction(random), random_rotation(random)},
            {random_direction(random) * apart, random_rotation(random)}};
}

void expect_sane(const std::vector<Manifold>& manifolds, double margin) {
    for (const Manifold& m : manifolds) {
        ASSERT_NEAR(length(m.normal), 1, 1e-9);
        ASSERT_GE(m.count, 1);
        ASSERT_LE(m.count, Manifold::max_points);
        for (int i = 0; i < m.count; ++i) {
            const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
            ASSERT_TRUE(is_finite(p.position));
            ASSERT_LE(p.separation, margin + 1e-12);
        }
    }
}

class ConvexFuzz : public testing::TestWithParam<int> {};

TEST_P(ConvexFuzz, depth_is_that_of_the_best_direction) {
    constexpr double margin = 0.05;
    const auto solids = all_solids();
    const Solid& first = solids[static_cast<std::size_t>(GetParam())];
    const auto a = make_shape(first.definition);
    double worst = 0;
    for (std::size_t other = 0; other < solids.size(); ++other) {
        const auto b = make_shape(solids[other].definition);
        Random random(100 + static_cast<std::uint64_t>(GetParam()) * 17 + other);
        for (int trial = 0; trial < 60; ++trial) {
            SCOPED_TRACE(std::string(first.name) + " and " + solids[other].name + ", trial " + std::to_string(trial));
            PosedPair pose = random_pair(random);
            pose.b.position += pose.a.position;
            const auto manifolds = contacts(*a, pose.a, *b, pose.b, margin);
            expect_sane(manifolds, margin);
            const double truth = true_separation(*a, pose.a, *b, pose.b, random);

            // Far apart: nothing. Near or overlapping: one region, in one part or two, and its depth is the smallest
            // way out.
            if (truth > margin + 1e-3) {
                EXPECT_TRUE(manifolds.empty());
            } else if (truth < margin - 1e-3) {
                ASSERT_GE(manifolds.size(), 1u);
                ASSERT_LE(manifolds.size(), 2u);
                ASSERT_EQ(manifolds[0].normal, manifolds.back().normal);
                const PlacedConvex placed_a = place(a->data().pieces[0], pose.a, pose.a.position);
                const PlacedConvex placed_b = place(b->data().pieces[0], pose.b, pose.a.position);
                const double along = separation_along(placed_a, placed_b, manifolds[0].normal);
                // No direction has more than the true separation, so only less would be wrong: then the search found a
                // better one.
                EXPECT_GE(along, truth - 1e-3 - 0.03 * std::fabs(truth));
                EXPECT_NEAR(deepest(manifolds), along, 1e-4);
                worst = std::max(worst, truth - along);
            }
        }
    }
    RecordProperty("worst_depth_error", std::to_string(worst));
}

// Resting contacts are shallow: there the normal is the best of all but for what faces are preferred by.
TEST_P(ConvexFuzz, no_direction_separates_a_shallow_overlap_by_less) {
    constexpr double depth = 1e-3, preference = 2e-4 + 0.02 * depth;
    const auto solids = all_solids();
    const auto a = make_shape(solids[static_cast<std::size_t>(GetParam())].definition);
    for (std::size_t other = 0; other < solids.size(); ++other) {
        const auto b = make_shape(solids[other].definition);
        Random random(700 + static_cast<std::uint64_t>(GetParam()) * 17 + other);
        for (int trial = 0; trial < 40; ++trial) {
            SCOPED_TRACE(std::string(solids[other].name) + ", trial " + std::to_string(trial));
            PosedPair pose = random_pair(random);
            pose.b.position += pose.a.position;
            for (int step = 0; step < 4; ++step) {
                const auto deep = contacts(*a, pose.a, *b, pose.b, 0.5);
                if (!deep.empty()) pose.b.position -= deep[0].normal * (deepest(deep) + depth);
            }
            const auto manifolds = contacts(*a, pose.a, *b, pose.b, 0);
            if (manifolds.empty() || deepest(manifolds) < -2 * depth) continue;
            EXPECT_GE(deepest(manifolds), true_separation(*a, pose.a, *b, pose.b, random) - preference);
        }
    }
}

TEST_P(ConvexFuzz, swapped_shapes_give_the_mirrored_contact) {
    const auto solids = all_solids();
    const auto a = make_shape(solids[static_cast<std::size_t>(GetParam())].definition);
    for (std::size_t other = 0; other < solids.size(); ++other) {
        const auto b = make_shape(solids[other].definition);
        Random random(900 + other);
        for (int trial = 0; trial < 100; ++trial) {
            PosedPair pose = random_pair(random);
            pose.b.position += pose.a.position;
            const auto forth = contacts(*a, pose.a, *b, pose.b, 0.02), back = contacts(*b, pose.b, *a, pose.a, 0.02);
            ASSERT_EQ(forth.size(), back.size());
            if (forth.empty()) continue;
            SCOPED_TRACE(std::string(solids[other].name) + ", trial " + std::to_string(trial));
            EXPECT_NEAR(deepest(forth), deepest(back), 2e-3 + 0.02 * std::fabs(deepest(forth)));
        }
    }
}

TEST_P(ConvexFuzz, moving_the_scene_moves_the_contact) {
    const auto solids = all_solids();
    const auto a = make_shape(solids[static_cast<std::size_t>(GetParam())].definition);
    const Transform moves[] = {{{10000, -3000, 7000}, {}},
                               {{0, 0, 0}, from_axis_angle(normalized(Vec3{1, 2, 3}), 1.1)}};
    for (std::size_t other = 0; other < solids.size(); ++other) {
        const auto b = make_shape(solids[other].definition);
        Random random(500 + other);
        for (int trial = 0; trial < 50; ++trial) {
            SCOPED_TRACE(std::string(solids[other].name) + ", trial " + std::to_string(trial));
            PosedPair pose = random_pair(random);
            pose.b.position += pose.a.position;
            const auto here = contacts(*a, pose.a, *b, pose.b, 0.02);
            for (const Transform& move : moves) {
                const auto there = contacts(*a, move * pose.a, *b, move * pose.b, 0.02);
                if (here.empty() || there.empty()) {
                    // Only where the gap is the margin itself may rounding decide.
                    EXPECT_EQ(here.empty(), there.empty());
                    continue;
                }
                EXPECT_NEAR(deepest(here), deepest(there), 1e-4 + 0.02 * std::fabs(deepest(here)));
            }
        }
    }
}

TEST_P(ConvexFuzz, moved_apart_by_their_depth_they_just_touch) {
    const auto solids = all_solids();
    const auto a = make_shape(solids[static_cast<std::size_t>(GetParam())].definition);
    for (std::size_t other = 0; other < solids.size(); ++other) {
        const auto b = make_shape(solids[other].definition);
        Random random(300 + other);
        for (int trial = 0; trial < 100; ++trial) {
            SCOPED_TRACE(std::string(solids[other].name) + ", trial " + std::to_string(trial));
            PosedPair pose = random_pair(random);
            pose.b.position += pose.a.position;
            const auto before = contacts(*a, pose.a, *b, pose.b, 0);
            if (before.empty()) continue;
            pose.b.position -= before[0].normal * (deepest(before) - 2e-3);
            EXPECT_LE(separation(*a, pose.a, *b, pose.b, 1), 4e-3 + 0.1 * std::fabs(deepest(before)));
            const auto after = contacts(*a, pose.a, *b, pose.b, 0);
            if (after.empty()) continue;
            EXPECT_GT(deepest(after), -2e-3);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EachWithAll, ConvexFuzz, testing::Range(0, static_cast<int>(all_solids().size())),
                         [](const auto& chosen) {
                             return std::string(all_solids()[static_cast<std::size_t>(chosen.param)].name);
                         });

}  // namespace
}  // namespace embody::physics::collision
