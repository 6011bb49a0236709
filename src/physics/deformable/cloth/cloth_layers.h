// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "math/bounds.h"
#include "physics/definitions/settings/thin_settings.h"
#include "physics/deformable/cloth/patch_tree.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/thin_pairs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A node over a triangle of the same sheet, or two of its edges that cross: Σ weight x is the vector between their
/// nearest points when the substep began, `distance` (m) long along the unit `normal`.
struct LayerContact {
    ThinFeature kind = ThinFeature::node_on_triangle;
    std::uint32_t first = 0, second = 0;  ///< node and triangle, or edges
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};
    Vec3 normal;
    double distance = 0;
};

/// Finds where a sheet may touch itself.
class ClothLayers {
public:
    ClothLayers(const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& nodes);

    /// Candidates that may come closer than twice `reach` (m) by these moves, in the order that PairSprings needs.
    [[nodiscard]] std::vector<ThinCandidate> near(const Nodes& nodes, double reach, std::span<const Vec3> moves,
                                                  const ClothSettings& settings, TaskPool& workers);
    /// All that may meet by these moves (m) and has no node in common, in no order. The same for any worker count.
    [[nodiscard]] std::vector<ThinCandidate> meeting(const Nodes& nodes, std::span<const Vec3> moves, double margin,
                                                     TaskPool& workers);
    /// Mean, m.
    [[nodiscard]] double edge_length() const { return edge_length_; }
    /// Each once.
    [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> edges() const { return edges_; }
    [[nodiscard]] const NodeStars& stars() const { return stars_; }

private:
    struct Search;
    // contacts_ as candidates.
    [[nodiscard]] std::vector<ThinCandidate> found() const;
    void find(const Search& search, TaskPool& workers);
    void find_boxes(const Search& search, TaskPool& workers);
    void search_pair(const Search& search, const std::array<std::uint32_t, 2>& leaves, std::vector<LayerContact>& nodes,
                     std::vector<LayerContact>& edges) const;
    void search_node(const Search& search, std::uint32_t node, std::uint32_t triangle,
                     std::vector<LayerContact>& found) const;
    void search_edges(const Search& search, std::uint32_t edge, std::uint32_t other,
                      std::vector<LayerContact>& found) const;
    // Of a displacement of some nodes.
    [[nodiscard]] Bounds box_around(const auto& nodes) const {
        Bounds box;
        for (const std::uint32_t node : nodes) box.add(node_boxes_[node]);
        return box;
    }
    [[nodiscard]] bool is_same_layer(const LayerContact& contact, double reach) const;

    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    NodeStars stars_;
    std::vector<Vec3> rest_, rest_normal_;  // of nodes, as it was made
    double edge_length_ = 0;                // mean, m
    PatchTree patches_;
    std::vector<std::vector<std::uint32_t>> leaf_nodes_, leaf_edges_;  // each in one leaf that has a triangle with it

    // Of the substep. Boxes hold the path of a feature, without the move of the whole, and the thickness around it.
    std::vector<Bounds> node_boxes_, triangle_boxes_;
    std::vector<LeanMask> leans_;  // of triangles, at its start and its end
    std::vector<std::array<std::uint32_t, 2>> leaf_pairs_;
    std::vector<LayerContact> contacts_;
};

}  // namespace embody::physics::deformable
