// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "physics/definitions/deformable_primitives.h"
#include "physics/deformable/contact/nearest_points.h"

namespace embody::physics::deformable {
namespace {

// A rectangle of 0.3 x 0.1 m rolled up along X, turns `gap` apart, about an axis along Z.
Nodes rolled_up(const DeformableDefinition& definition, double gap) {
    Nodes nodes;
    const double pitch = gap / (2 * std::acos(-1.0)), inner = 0.01;
    for (const Vec3 flat : definition.nodes) {
        // Of r = inner + pitch t the length up to t is near enough inner t + pitch t²/2.
        const double s = flat.x + 0.15, t = (std::sqrt(inner * inner + 2 * pitch * s) - inner) / pitch;
        const double r = inner + pitch * t;
        nodes.position.push_back({r * std::cos(t), r * std::sin(t), flat.z});
    }
    nodes.mass.assign(nodes.position.size(), 1e-3);
    nodes.inverse_mass.assign(nodes.position.size(), 1e3);
    nodes.velocity = nodes.mean_velocity = std::vector<Vec3>(nodes.position.size());
    return nodes;
}

TEST(ClothLayers, FindWhatASearchOfAllFinds) {
    constexpr double gap = 2e-3;
    const auto definition = cloth_rectangle(0.3, 0.1, 0.005, {});
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    const Nodes nodes = rolled_up(definition, gap);
    const std::vector<Vec3>& x = nodes.position;
    ClothLayers layers(triangles, definition.nodes);
    TaskPool alone(1), two(2);
    const std::vector<Vec3> still(x.size());
    const auto near = layers.near(nodes, 0.75 * gap, still, {}, alone);
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const ThinCandidate& candidate : near) {
        if (candidate.kind == ThinFeature::node_on_triangle) found.emplace(candidate.first, candidate.second);
    }
    int expected = 0;
    for (std::uint32_t i = 0; i < x.size(); ++i) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto [p, q, r] = triangles[t];
            const auto w = nearest_weights(x[i], x[p], x[q], x[r]);
            const auto& flat = definition.nodes;
            const Vec3 rest = flat[i] - (w[0] * flat[p] + w[1] * flat[q] + w[2] * flat[r]);
            const double away = length(x[i] - (w[0] * x[p] + w[1] * x[q] + w[2] * x[r]));
            if (away > 1.2 * gap || length(rest) < 0.02) continue;
            ++expected;
            EXPECT_TRUE(found.contains({i, t})) << "node " << i << " and triangle " << t;
        }
    }
    EXPECT_GT(expected, 500);
    const auto shared = layers.near(nodes, 0.75 * gap, still, {}, two);
    ASSERT_EQ(shared.size(), near.size());
    for (std::size_t k = 0; k < near.size(); ++k) {
        EXPECT_EQ(shared[k].first, near[k].first);
        EXPECT_EQ(shared[k].second, near[k].second);
    }
}

TEST(ClothLayers, OfAFlatSheetNothingIsNear) {
    const auto definition = cloth_rectangle(1, 1, 0.02, {});
    const auto& triangles = std::get<Cloth>(definition.matter).triangles;
    Nodes nodes = rolled_up(definition, 1e-3);
    nodes.position = definition.nodes;
    ClothLayers layers(triangles, definition.nodes);
    TaskPool alone(1);
    // Neither lying nor standing, whichever way it looks, nor where it is thicker than its edges are long.
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, normalized(Vec3{1, 2, 3})}) {
        for (std::size_t i = 0; i < nodes.size(); ++i)
            nodes.position[i] = rotate(from_axis_angle(axis, 1.1), definition.nodes[i]);
        const std::vector<Vec3> still(nodes.size());
        for (const double reach : {1e-3, 0.03}) EXPECT_TRUE(layers.near(nodes, reach, still, {}, alone).empty());
    }
}

}  // namespace
}  // namespace embody::physics::deformable
