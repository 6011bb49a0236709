// SPDX-License-Identifier: MIT
// When features meet, and what holds sheets apart, against motions that are sampled.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/random.h"
#include "foundation/task_pool.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/contact/crossing_guard.h"
#include "physics/deformable/contact/time_of_impact.h"

namespace embody::physics::deformable {
namespace {

Vec3 any_vector(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

// Points of a node, an edge or a triangle.
std::vector<Vec3> points_of(std::span<const Vec3> corners) {
    constexpr int parts = 12;
    std::vector<Vec3> points;
    for (int i = 0; i <= parts; ++i) {
        for (int k = 0; k <= (corners.size() == 3 ? parts - i : 0); ++k) {
            const double a = static_cast<double>(i) / parts, b = static_cast<double>(k) / parts;
            if (corners.size() == 1) return {corners[0]};
            if (corners.size() == 2) points.push_back(corners[0] + a * (corners[1] - corners[0]));
            if (corners.size() == 3)
                points.push_back(corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]));
        }
    }
    return points;
}

TEST(FirstImpact, MissesNothingThatSamplesFind) {
    Random random(1);
    int found = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        MovingFeatures features{.kind = static_cast<ThinFeature>(trial % 3), .start = {}, .move = {}};
        const std::size_t first = features.kind == ThinFeature::edge_on_edge ? 2 : 1;
        const std::size_t count = features.kind == ThinFeature::node_on_edge ? 3 : 4;
        const double speed = std::pow(10.0, random.between(-1, 1)), distance = random.between(0.01, 0.5);
        for (std::size_t k = 0; k < count; ++k) {
            features.start[k] = any_vector(random, 0.5);
            features.move[k] = any_vector(random, speed);
        }
        const auto nearest = [&](double time) {
            std::array<Vec3, 4> x;
            for (std::size_t k = 0; k < count; ++k) x[k] = features.start[k] + time * features.move[k];
            double least = std::numeric_limits<double>::infinity();
            const std::span<const Vec3> all(x.data(), count);
            for (const Vec3 a : points_of(all.first(first))) {
                for (const Vec3 b : points_of(all.subspan(first))) least = std::min(least, length(a - b));
            }
            return least;
        };
        const std::optional<Impact> impact = first_impact(features, distance);
        // Samples are farther than the features: where they are that near, these are.
        const double limit = 0.01 * distance;
        for (int i = 0; i <= 100; ++i) {
            const double time = i / 100.0;
            if (impact && time >= impact->time) break;
            if (i == 0 && nearest(0) < limit) break;
            EXPECT_GE(nearest(time), limit) << trial << " at " << time;
        }
        if (!impact) continue;
        ++found;
        Vec3 away, start;
        for (std::size_t k = 0; k < count; ++k) {
            away += impact->weight[k] * (features.start[k] + impact->time * features.move[k]);
            start += impact->weight[k] * features.start[k];
        }
        EXPECT_LE(length(away), nearest(impact->time) + 1e-12) << trial;
        EXPECT_GE(length(away), limit) << trial;
        EXPECT_LT(length(away), 0.2 * length(start) + limit) << trial << ": so near that they might meet";
        EXPECT_NEAR(dot(impact->normal, away), length(away), 1e-12) << trial;
    }
    EXPECT_GT(found, 100);
}

TEST(FirstImpact, FeaturesThatMoveTogetherDoNotMeet) {
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        MovingFeatures features{.kind = ThinFeature::edge_on_edge, .start = {}, .move = {}};
        const Vec3 move = any_vector(random, 100);
        for (std::size_t k = 0; k < 4; ++k) {
            features.start[k] = any_vector(random, 0.5);
            features.move[k] = move;
        }
        EXPECT_FALSE(first_impact(features, 0.1)) << trial;
    }
}

bool passes(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
    const auto volume = [](Vec3 o, Vec3 x, Vec3 y, Vec3 z) { return dot(cross(x - o, y - o), z - o); };
    if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
    const bool side = volume(p, q, a, b) > 0;
    return side == (volume(p, q, b, c) > 0) && side == (volume(p, q, c, a) > 0);
}

// Two sheets above each other, with a move of each node in any direction, by up to ten times their distance.
TEST(CrossingGuard, HoldsSheetsApartWhateverTheirMoves) {
    TaskPool workers(1);
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        std::array<Nodes, 2> nodes;
        std::array<std::vector<std::array<std::uint32_t, 3>>, 2> triangles;
        std::vector<ClothLayers> layers;
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            const auto sheet = cloth_rectangle(0.3, 0.3, random.between(0.05, 0.1));
            triangles[i] = std::get<Cloth>(sheet.matter).triangles;
            for (const Vec3 node : sheet.nodes)
                nodes[i].position.push_back(node + Vec3{0.02 * trial / 20.0, 0.01 * static_cast<double>(i), 0});
            nodes[i].velocity = nodes[i].mean_velocity = std::vector<Vec3>(sheet.nodes.size());
            for (std::size_t k = 0; k < sheet.nodes.size(); ++k) {
                nodes[i].mass.push_back(random.between(0.1, 1));
                nodes[i].inverse_mass.push_back(1 / nodes[i].mass.back());
            }
            layers.emplace_back(triangles[i], nodes[i].position);
        }
        std::vector<ThinMember> members;
        std::vector<double> compliance;
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            ThinSurface surface{.nodes = &nodes[i], .triangles = triangles[i], .edges = layers[i].edges()};
            surface.radius = 0.001;
            surface.stars = &layers[i].stars();
            surface.edge_length = layers[i].edge_length();
            members.push_back(
                {surface, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(compliance.size()), {}, {}});
            compliance.insert(compliance.end(), nodes[i].inverse_mass.begin(), nodes[i].inverse_mass.end());
        }
        const std::array<CrossingGuard::Pair, 3> pairs{CrossingGuard::Pair{0, 0, layers.data(), {}},
                                                       CrossingGuard::Pair{0, 1, nullptr, {}},
                                                       CrossingGuard::Pair{1, 1, &layers[1], {}}};
        CrossingGuard guard(members, pairs, workers);
        std::vector<Vec3> moves(compliance.size());
        Vec3 momentum, kept;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            moves[i] = any_vector(random, 0.005 * (1 + trial));
            momentum += moves[i] / compliance[i];
        }
        EXPECT_TRUE(trial < 5 || !guard.find(moves).empty()) << trial << ": nothing to hold";
        guard.hold(compliance, moves);
        EXPECT_TRUE(guard.find(moves).empty()) << trial;
        for (std::size_t i = 0; i < moves.size(); ++i) kept += moves[i] / compliance[i];
        EXPECT_LT(length(kept - momentum), 1e-12) << trial;
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
                const auto at = [&](std::size_t sheet, std::uint32_t node) {
                    return nodes[sheet].position[node] + moves[members[sheet].first + node];
                };
                for (const auto& [p, q] : members[i].surface.edges) {
                    for (const auto& [a, b, c] : triangles[k]) {
                        if (i == k && (p == a || p == b || p == c || q == a || q == b || q == c)) continue;
                        EXPECT_FALSE(passes(at(i, p), at(i, q), at(k, a), at(k, b), at(k, c))) << trial;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace embody::physics::deformable
