// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_layers.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/deformable/contact/nearest_points.h"

namespace embody::physics::deformable {

struct ClothLayers::Search {
    const ClothLayers& layers;
    const Nodes& nodes;
    std::span<const Vec3> moves;
    double thickness = 0;
    double same_layer_reach = 0;  // m
    bool takes_all = false;       // whose paths' boxes overlap, however near they come

    // Adds it if it may come nearer than twice the thickness.
    void add(LayerContact contact, Vec3 away, std::vector<LayerContact>& found) const {
        constexpr double same_place = 1e-9;  // m: nearer ones have no direction
        contact.distance = length(away);
        if (contact.distance < same_place || layers.is_same_layer(contact, same_layer_reach)) return;
        contact.normal = away / contact.distance;
        double end = contact.distance;
        for (std::size_t k = 0; k < 4; ++k) end += contact.weight[k] * dot(contact.normal, moves[contact.node[k]]);
        if (end < 2 * thickness) found.push_back(contact);
    }
};

ClothLayers::ClothLayers(const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& nodes)
    : triangles_(triangles), rest_(nodes), rest_normal_(nodes.size()), patches_(triangles, nodes.size()) {
    leaf_nodes_.resize(patches_.leaves());
    leaf_edges_.resize(patches_.leaves());
    std::vector<bool> has_leaf(nodes.size(), false);
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const auto& triangle = triangles_[t];
        const std::uint32_t leaf = patches_.leaf_of(t);
        const Vec3 normal = cross(nodes[triangle[1]] - nodes[triangle[0]], nodes[triangle[2]] - nodes[triangle[0]]);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!has_leaf[triangle[k]]) leaf_nodes_[leaf].push_back(triangle[k]);
            has_leaf[triangle[k]] = true;
            rest_normal_[triangle[k]] += normal;
            const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            if (!known.emplace(a, b).second) continue;
            leaf_edges_[leaf].push_back(static_cast<std::uint32_t>(edges_.size()));
            edges_.push_back({a, b});
            edge_length_ += length(nodes[b] - nodes[a]);
        }
    }
    edge_length_ /= static_cast<double>(edges_.size());
    stars_ = NodeStars(nodes.size(), edges_, triangles_);
}

// Features that lay that close on the same side when the sheet was made belong together.
bool ClothLayers::is_same_layer(const LayerContact& contact, double reach) const {
    const std::size_t other = contact.kind == ThinFeature::edge_on_edge ? 2 : 1;
    if (dot(rest_normal_[contact.node[0]], rest_normal_[contact.node[other]]) <= 0) return false;
    Vec3 away;
    for (std::size_t k = 0; k < 4; ++k) away += contact.weight[k] * rest_[contact.node[k]];
    return length(away) < reach;
}

// The move of the whole is left out: parts that fall together do not meet.
void ClothLayers::find_boxes(const Search& search, TaskPool& workers) {
    const Nodes& nodes = search.nodes;
    Vec3 mean;
    double mass = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mean += nodes.mass[i] * search.moves[i];
        mass += nodes.mass[i];
    }
    mean = mean / mass;
    node_boxes_.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 start = nodes.position[i], end = start + search.moves[i] - mean;
        node_boxes_[i] = enlarged(Bounds{min(start, end), max(start, end)}, search.thickness);
    }
    triangle_boxes_.resize(triangles_.size());
    leans_.resize(triangles_.size());
    parallel_for(workers, triangles_.size(), triangles_.size() >= 1000, [&](int, IndexRange range) {
        for (std::size_t t = range.first; t < range.last; ++t) {
            const auto [p, q, r] = triangles_[t];
            triangle_boxes_[t] = box_around(triangles_[t]);
            const Vec3 a = nodes.position[q] - nodes.position[p], b = nodes.position[r] - nodes.position[p];
            const Vec3 a_displacement = search.moves[q] - search.moves[p],
                       b_displacement = search.moves[r] - search.moves[p];
            // The normal on the way is a quadratic curve: it lies between these three (its Bernstein coefficients).
            const Vec3 start = cross(a, b), end = cross(a + a_displacement, b + b_displacement);
            const Vec3 middle = start + (cross(a, b_displacement) + cross(a_displacement, b)) / 2;
            leans_[t] = leans_of(start) & leans_of(middle) & leans_of(end);
        }
    });
    patches_.update(triangle_boxes_, leans_);
}

void ClothLayers::search_node(const Search& search, std::uint32_t node, std::uint32_t triangle,
                              std::vector<LayerContact>& found) const {
    const std::vector<Vec3>& x = search.nodes.position;
    const auto [p, q, r] = triangles_[triangle];
    if (node == p || node == q || node == r || !overlaps(triangle_boxes_[triangle], node_boxes_[node])) return;
    if (search.takes_all) {
        found.push_back({ThinFeature::node_on_triangle, node, triangle, {node, p, q, r}, {}, {}, 0});
        return;
    }
    const auto weight = nearest_weights(x[node], x[p], x[q], x[r]);
    const Vec3 away = x[node] - (weight[0] * x[p] + weight[1] * x[q] + weight[2] * x[r]);
    search.add({ThinFeature::node_on_triangle,
                node,
                triangle,
                {node, p, q, r},
                {1, -weight[0], -weight[1], -weight[2]},
                {},
                0},
               away, found);
}

void ClothLayers::search_edges(const Search& search, std::uint32_t edge, std::uint32_t other,
                               std::vector<LayerContact>& found) const {
    const std::vector<Vec3>& x = search.nodes.position;
    const auto [a, b] = edges_[edge];
    const auto [c, d] = edges_[other];
    if (a == c || a == d || b == c || b == d) return;
    if (search.takes_all) {
        found.push_back({ThinFeature::edge_on_edge, edge, other, {a, b, c, d}, {}, {}, 0});
        return;
    }
    double s = 0, u = 0;
    if (!nearest_inside(x[a], x[b], x[c], x[d], s, u)) return;
    const Vec3 away = (1 - s) * x[a] + s * x[b] - (1 - u) * x[c] - u * x[d];
    search.add({ThinFeature::edge_on_edge, edge, other, {a, b, c, d}, {1 - s, s, u - 1, -u}, {}, 0}, away, found);
}

// All of one leaf with all of another, or with its own.
void ClothLayers::search_pair(const Search& search, const std::array<std::uint32_t, 2>& leaves,
                              std::vector<LayerContact>& nodes, std::vector<LayerContact>& edges) const {
    const bool is_own = leaves[0] == leaves[1];
    for (const bool is_swapped : {false, true}) {
        const std::uint32_t of_nodes = leaves[is_swapped ? 1 : 0], of_triangles = leaves[is_swapped ? 0 : 1];
        if (is_swapped && is_own) break;
        const Bounds& box = patches_.box_of(of_triangles);
        for (const std::uint32_t node : leaf_nodes_[of_nodes]) {
            if (!overlaps(node_boxes_[node], box)) continue;
            for (const std::uint32_t triangle : patches_.triangles_of(of_triangles))
                search_node(search, node, triangle, nodes);
        }
    }
    for (const std::uint32_t edge : leaf_edges_[leaves[0]]) {
        const Bounds box = box_around(edges_[edge]);
        if (!overlaps(box, patches_.box_of(leaves[1]))) continue;
        for (const std::uint32_t other : leaf_edges_[leaves[1]]) {
            if ((!is_own || edge < other) && overlaps(box, box_around(edges_[other])))
                search_edges(search, edge, other, edges);
        }
    }
}

void ClothLayers::find(const Search& search, TaskPool& workers) {
    find_boxes(search, workers);
    patches_.find_pairs(leaf_pairs_);
    struct Found {
        std::vector<LayerContact> nodes, edges;
    };
    std::vector<Found> found(static_cast<std::size_t>(std::max(1, workers.workers())));
    parallel_for(workers, leaf_pairs_.size(), leaf_pairs_.size() >= 200, [&](int worker, IndexRange range) {
        Found& own = found[static_cast<std::size_t>(worker)];
        for (std::size_t p = range.first; p < range.last; ++p)
            search_pair(search, leaf_pairs_[p], own.nodes, own.edges);
    });
    // Whatever the order of the patches.
    contacts_.clear();
    const auto append = [&](std::vector<LayerContact> Found::*kind) {
        const auto first = static_cast<std::ptrdiff_t>(contacts_.size());
        for (const Found& own : found) contacts_.insert(contacts_.end(), (own.*kind).begin(), (own.*kind).end());
        std::sort(contacts_.begin() + first, contacts_.end(),
                  [](const LayerContact& a, const LayerContact& b) { return a.node < b.node; });
    };
    append(&Found::nodes);
    append(&Found::edges);
}

std::vector<ThinCandidate> ClothLayers::near(const Nodes& nodes, double reach, std::span<const Vec3> moves,
                                             const ClothSettings& settings, TaskPool& workers) {
    find({*this, nodes, moves, reach, settings.same_layer_reach * reach}, workers);
    std::vector<ThinCandidate> candidates = found();
    std::ranges::stable_sort(candidates, {}, [](const ThinCandidate& c) { return std::pair(c.kind, c.first); });
    return candidates;
}

std::vector<ThinCandidate> ClothLayers::meeting(const Nodes& nodes, std::span<const Vec3> moves, double margin,
                                                TaskPool& workers) {
    find({*this, nodes, moves, margin, 0, true}, workers);
    return found();
}

std::vector<ThinCandidate> ClothLayers::found() const {
    std::vector<ThinCandidate> candidates;
    for (const LayerContact& contact : contacts_)
        candidates.push_back({contact.kind, false, contact.first, contact.second});
    return candidates;
}

}  // namespace embody::physics::deformable
