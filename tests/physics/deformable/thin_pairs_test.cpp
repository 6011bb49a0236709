// SPDX-License-Identifier: MIT
// What of two sheets may touch, and where.
#include "physics/deformable/contact/thin_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "foundation/random.h"
#include "foundation/task_pool.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/cloth/cloth_layers.h"
#include "physics/deformable/contact/nearest_points.h"
#include "physics/deformable/test_nodes.h"

namespace embody::physics::deformable {
namespace {

// Sheets that cross: candidates hold every pair that is near, and nearest points are so far apart as a trial finds.
TEST(ThinPairs, CandidatesHoldAllThatIsNear) {
    Random random(5);
    TaskPool workers(1);
    const DeformableDefinition definition = cloth_rectangle(0.4, 0.3, 0.1);
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    std::set<std::array<std::uint32_t, 2>> unique;
    for (const auto& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k)
            unique.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    }
    const std::vector<std::array<std::uint32_t, 2>> edges(unique.begin(), unique.end());
    constexpr double radius = 0.01;
    for (int trial = 0; trial < 10; ++trial) {
        Nodes below = nodes_at(definition.nodes), above = nodes_at(definition.nodes);
        const Vec3 displacement{random.between(-0.1, 0.1), 0.015, random.between(-0.1, 0.1)};
        for (Vec3& p : above.position) p += displacement + Vec3{0, random.between(-0.01, 0.03), 0};
        const ThinSurface a{&below, triangles, edges, radius, 0.1}, b{&above, triangles, edges, radius, 0.1};
        std::vector<ThinCandidate> candidates;
        find_thin_candidates(a, b, 1.0 / 60, 9.81, workers, candidates);
        std::set<std::pair<std::uint32_t, std::uint32_t>> listed;
        int nearer = 0;
        for (const ThinCandidate& candidate : candidates) {
            if (candidate.kind == ThinFeature::node_on_triangle && candidate.is_swapped) {
                listed.insert({candidate.first, candidate.second});
            }
            ThinPoints points;
            if (!find_points(a, b, candidate, 0, points)) continue;
            // The weighted sum is the way, and no other weights of the same features give a shorter one.
            const Nodes &first = candidate.is_swapped ? above : below, &second = candidate.is_swapped ? below : above;
            const auto sum = [&](const std::array<double, 4>& weight) {
                Vec3 total;
                for (int i = 0; i < points.count; ++i) {
                    const auto k = static_cast<std::size_t>(i);
                    total += (i < points.count_first ? first : second).position[points.node[k]] * weight[k];
                }
                return total;
            };
            EXPECT_LT(length(sum(points.weight) - points.away), 1e-9);
            double one = 0, other = 0;
            for (int i = 0; i < points.count; ++i) {
                (i < points.count_first ? one : other) += points.weight[static_cast<std::size_t>(i)];
            }
            EXPECT_NEAR(one, 1, 1e-9);
            EXPECT_NEAR(other, -1, 1e-9);
            nearer += length(points.away) < 2 * radius;
        }
        EXPECT_GT(nearer, 0);
        EXPECT_TRUE(will_touch(a, b, candidates, 1.0 / 60, 9.81));
        // Nodes of the upper one straight over a triangle of the lower one, nearer than both radii.
        for (std::uint32_t node = 0; node < above.size(); ++node) {
            const Vec3 p = above.position[node];
            if (p.y > 2 * radius) continue;
            for (std::uint32_t t = 0; t < triangles.size(); ++t) {
                const Vec3 o = below.position[triangles[t][0]], u = below.position[triangles[t][1]] - o,
                           v = below.position[triangles[t][2]] - o, n = cross(u, v);
                const double s = dot(cross(p - o, v), n) / length_squared(n),
                             r = dot(cross(u, p - o), n) / length_squared(n);
                if (s < 0.01 || r < 0.01 || s + r > 0.99) continue;
                EXPECT_TRUE(listed.contains({node, t}));
            }
        }
        // Far apart there are none.
        for (Vec3& p : above.position) p.y += 3;
        candidates.clear();
        find_thin_candidates(a, b, 1.0 / 60, 9.81, workers, candidates);
        EXPECT_TRUE(candidates.empty());
        EXPECT_FALSE(will_touch(a, b, candidates, 1.0 / 60, 9.81));
    }
}

// Two crumpled sheets: the two points of all features that are nearest to each other are a contact, and each contact is
// where going on in the sheet, either way, leads away from the other's point.
TEST(ThinPairs, ContactsAreWhereNothingAroundIsNearer) {
    Random random(6);
    const DeformableDefinition definition = cloth_rectangle(0.4, 0.3, 0.1);
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    const ClothLayers layers(triangles, definition.nodes);
    int contacts = 0, others = 0;
    for (int trial = 0; trial < 20; ++trial) {
        Nodes below = nodes_at(definition.nodes), above = nodes_at(definition.nodes);
        for (Nodes* nodes : {&below, &above}) {
            for (Vec3& p : nodes->position)
                p += {random.between(-0.02, 0.02), random.between(-0.03, 0.03), random.between(-0.02, 0.02)};
        }
        for (Vec3& p : above.position) p += {random.between(-0.02, 0.02), 0.12, 0};
        ThinSurface a{&below, triangles, layers.edges(), 0.01, 0.1, &layers.stars()}, b = a;
        b.nodes = &above;
        double nearest = 1, nearest_contact = 1;
        const auto look = [&](ThinFeature kind, bool is_swapped, std::uint32_t first, std::uint32_t second) {
            const ThinCandidate candidate{kind, is_swapped, first, second};
            ThinPoints points;
            if (!find_points(a, b, candidate, 0, points)) return;
            nearest = std::min(nearest, length(points.away));
            const bool is_contact = are_nearest(a, b, candidate, 0, points);
            ++(is_contact ? contacts : others);
            if (!is_contact) return;
            nearest_contact = std::min(nearest_contact, length(points.away));
            if (kind == ThinFeature::edge_on_edge) return;
            // From the nearest point of the other sheet a little towards any node of the triangles around it.
            const Nodes &own = is_swapped ? above : below, &other = is_swapped ? below : above;
            const Vec3 foot = own.position[first] - points.away;
            for (const auto& t : triangles) {
                const Vec3 p = other.position[t[0]], q = other.position[t[1]], r = other.position[t[2]];
                const auto w = nearest_weights(foot, p, q, r);
                if (length(w[0] * p + w[1] * q + w[2] * r - foot) > 1e-9) continue;
                for (const Vec3 corner : {p, q, r})
                    EXPECT_GE(length(own.position[first] - (foot + 1e-3 * (corner - foot))),
                              length(points.away) - 1e-9);
            }
        };
        for (const bool is_swapped : {false, true}) {
            for (std::uint32_t node = 0; node < below.size(); ++node) {
                for (std::uint32_t t = 0; t < triangles.size(); ++t)
                    look(ThinFeature::node_on_triangle, is_swapped, node, t);
            }
        }
        for (std::uint32_t e = 0; e < a.edges.size(); ++e) {
            for (std::uint32_t f = 0; f < b.edges.size(); ++f) look(ThinFeature::edge_on_edge, false, e, f);
        }
        EXPECT_EQ(nearest, nearest_contact);
    }
    EXPECT_GT(contacts, 100);
    EXPECT_GT(others, 1000);
}

TEST(NodeStars, AreTheFeaturesWithTheNode) {
    const DeformableDefinition definition = cloth_rectangle(0.4, 0.3, 0.1);
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    const ClothLayers layers(triangles, definition.nodes);
    const auto check = [](std::span<const std::uint32_t> around, const auto& features, std::uint32_t node) {
        std::vector<std::uint32_t> with;
        for (std::uint32_t f = 0; f < features.size(); ++f) {
            if (std::ranges::count(features[f], node) > 0) with.push_back(f);
        }
        EXPECT_TRUE(std::ranges::equal(around, with));
        EXPECT_FALSE(with.empty());
    };
    for (std::uint32_t node = 0; node < definition.nodes.size(); ++node) {
        check(layers.stars().edges(node), layers.edges(), node);
        check(layers.stars().triangles(node), triangles, node);
    }
}

}  // namespace
}  // namespace embody::physics::deformable
