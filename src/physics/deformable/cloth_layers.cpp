// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth_layers.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "physics/deformable/nearest_points.h"

namespace embody::physics {

struct ClothLayers::Search {
    const Nodes& nodes;
    std::span<const Vec3> moves;
    double thickness = 0;

    // Adds it if it may come nearer than twice the thickness.
    void add(LayerContact contact, Vec3 away, std::vector<LayerContact>& found) const {
        contact.distance = length(away);
        if (contact.distance < 1e-9) return;
        contact.normal = away / contact.distance;
        double end = contact.distance;
        for (std::size_t k = 0; k < 4; ++k) end += contact.weight[k] * dot(contact.normal, moves[contact.node[k]]);
        if (end < 2 * thickness) found.push_back(contact);
    }
};

ClothLayers::ClothLayers(const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& nodes)
    : triangles_(triangles) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    std::vector<std::vector<std::uint32_t>> around(nodes.size());
    for (const auto& triangle : triangles_) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            if (!known.emplace(a, b).second) continue;
            edges_.push_back({a, b});
            around[a].push_back(b);
            around[b].push_back(a);
            edge_length_ += length(nodes[b] - nodes[a]);
        }
    }
    edge_length_ /= static_cast<double>(edges_.size());
    neighbour_start_.push_back(0);
    for (const auto& of_node : around) {
        neighbours_.insert(neighbours_.end(), of_node.begin(), of_node.end());
        neighbour_start_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    }
}

bool ClothLayers::are_neighbours(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    for (std::uint32_t k = neighbour_start_[a]; k < neighbour_start_[a + 1]; ++k) {
        if (neighbours_[k] == b) return true;
    }
    return false;
}

// The whole's own move is left out: what falls together does not meet.
void ClothLayers::find_boxes(const Search& search) {
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
    const auto joined = [&](const auto& corners) {
        Bounds box;
        for (const std::uint32_t corner : corners) box.add(node_boxes_[corner]);
        return box;
    };
    edge_boxes_.resize(edges_.size());
    triangle_boxes_.resize(triangles_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) edge_boxes_[e] = joined(edges_[e]);
    for (std::size_t t = 0; t < triangles_.size(); ++t) triangle_boxes_[t] = joined(triangles_[t]);
}

void ClothLayers::search_node(const Search& search, std::uint32_t node, std::vector<std::uint32_t>& seen,
                              std::vector<LayerContact>& found) const {
    const std::vector<Vec3>& x = search.nodes.position;
    const Bounds& box = node_boxes_[node];
    const std::size_t first_found = found.size();
    // Where neighbours lie nearer than layers may.
    const bool is_fine = edge_length_ < 4 * search.thickness;
    const auto is_near = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
        return are_neighbours(node, p) || are_neighbours(node, q) || are_neighbours(node, r);
    };
    grid_.visit(box, [&](std::uint32_t t) {
        if (!overlaps(triangle_boxes_[t], box) || seen[t] == node) return;
        seen[t] = node;
        const auto [p, q, r] = triangles_[t];
        if (node == p || node == q || node == r || (is_fine && is_near(p, q, r))) return;
        const auto weight = nearest_weights(x[node], x[p], x[q], x[r]);
        const Vec3 away = x[node] - (weight[0] * x[p] + weight[1] * x[q] + weight[2] * x[r]);
        search.add({{node, p, q, r}, {1, -weight[0], -weight[1], -weight[2]}, {}, 0}, away, found);
    });
    // Whatever the order of the cells.
    const auto order = [](const LayerContact& a, const LayerContact& b) { return a.node < b.node; };
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first_found), found.end(), order);
}

void ClothLayers::search_edge(const Search& search, std::uint32_t edge, std::vector<std::uint32_t>& seen,
                              std::vector<LayerContact>& found) const {
    const std::vector<Vec3>& x = search.nodes.position;
    const std::uint32_t a = edges_[edge][0], b = edges_[edge][1];
    const Bounds& box = edge_boxes_[edge];
    const std::size_t first_found = found.size();
    edge_grid_.visit(box, [&](std::uint32_t other) {
        if (other <= edge || seen[other] == edge) return;
        seen[other] = edge;
        const auto [c, d] = edges_[other];
        if (a == c || a == d || b == c || b == d || !overlaps(edge_boxes_[other], box)) return;
        double s = 0, u = 0;
        if (!nearest_inside(x[a], x[b], x[c], x[d], s, u)) return;
        const Vec3 away = (1 - s) * x[a] + s * x[b] - (1 - u) * x[c] - u * x[d];
        search.add({{a, b, c, d}, {1 - s, s, u - 1, -u}, {}, 0}, away, found);
    });
    const auto order = [](const LayerContact& p, const LayerContact& q) { return p.node < q.node; };
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first_found), found.end(), order);
}

void ClothLayers::find(const Nodes& nodes, double thickness, std::span<const Vec3> moves, TaskPool& workers) {
    const std::size_t count = nodes.size();
    const Search search{nodes, moves, thickness};
    find_boxes(search);
    grid_.fill(triangle_boxes_, edge_length_);
    edge_grid_.fill(edge_boxes_, edge_length_);
    const int number = std::max(1, workers.workers());
    std::vector<std::vector<LayerContact>> of_nodes(static_cast<std::size_t>(number)), of_edges(of_nodes);
    share_among(workers, count, count >= 1000, [&](int worker, Share share) {
        std::vector<std::uint32_t> seen(triangles_.size(), 0xFFFFFFFFu);
        for (std::size_t i = share.first; i < share.last; ++i)
            search_node(search, static_cast<std::uint32_t>(i), seen, of_nodes[static_cast<std::size_t>(worker)]);
    });
    share_among(workers, edges_.size(), count >= 1000, [&](int worker, Share share) {
        std::vector<std::uint32_t> seen(edges_.size(), 0xFFFFFFFFu);
        for (std::size_t e = share.first; e < share.last; ++e)
            search_edge(search, static_cast<std::uint32_t>(e), seen, of_edges[static_cast<std::size_t>(worker)]);
    });
    contacts_.clear();
    for (const auto* lists : {&of_nodes, &of_edges}) {
        for (const auto& list : *lists) contacts_.insert(contacts_.end(), list.begin(), list.end());
    }
}

namespace {

Vec3 way_of(const LayerContact& contact, std::span<const Vec3> moves) {
    Vec3 way;
    for (std::size_t k = 0; k < 4; ++k) way += contact.weight[k] * moves[contact.node[k]];
    return way;
}

double give_of(const LayerContact& contact, std::span<const double> give) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += contact.weight[k] * contact.weight[k] * give[contact.node[k]];
    return sum;
}

void push(const LayerContact& contact, Vec3 by, std::span<const double> give, std::span<Vec3> moves) {
    for (std::size_t k = 0; k < 4; ++k) moves[contact.node[k]] += (contact.weight[k] * give[contact.node[k]]) * by;
}

// Where pushes did not part them all: nodes that would pass through each other go together for this substep, with the
// mean of their moves (X. Provot, "Collision and self-collision handling in cloth model", 1997).
void join(std::span<const LayerContact> contacts, double thickness, std::span<const double> give,
          std::span<Vec3> moves) {
    constexpr double least_share = 0.2;
    constexpr int most_rounds = 20;
    std::vector<std::uint32_t> zone(moves.size());
    for (std::uint32_t i = 0; i < zone.size(); ++i) zone[i] = i;
    const auto root_of = [&](std::uint32_t i) {
        while (zone[i] != i) i = zone[i] = zone[zone[i]];
        return i;
    };
    for (int round = 0; round < most_rounds; ++round) {
        bool has_joined = false;
        for (const LayerContact& contact : contacts) {
            const double end = contact.distance + dot(contact.normal, way_of(contact, moves));
            if (end >= least_share * std::min(thickness, contact.distance)) continue;
            for (std::size_t k = 1; k < 4; ++k) {
                const std::uint32_t a = root_of(contact.node[0]), b = root_of(contact.node[k]);
                if (a == b) continue;
                has_joined = true;
                zone[std::max(a, b)] = std::min(a, b);
            }
        }
        if (!has_joined) return;
        std::vector<double> weight(moves.size(), 0);
        std::vector<Vec3> sum(moves.size());
        std::vector<bool> is_held(moves.size(), false), is_joined(moves.size(), false);
        for (std::uint32_t i = 0; i < moves.size(); ++i) {
            const std::uint32_t root = root_of(i);
            if (root != i) is_joined[root] = true;
            if (give[i] == 0) {
                is_held[root] = true;
                continue;
            }
            weight[root] += 1 / give[i];
            sum[root] += (1 / give[i]) * moves[i];
        }
        for (std::uint32_t i = 0; i < moves.size(); ++i) {
            const std::uint32_t root = root_of(i);
            if (is_joined[root] && give[i] > 0) moves[i] = is_held[root] ? Vec3{} : sum[root] / weight[root];
        }
    }
}

}  // namespace

double ClothLayers::longest_way(const Nodes& nodes, double thickness, std::span<const Vec3> moves, TaskPool& workers) {
    find(nodes, thickness, moves, workers);
    double longest = 0;
    for (const LayerContact& contact : contacts_) longest = std::max(longest, length(way_of(contact, moves)));
    return longest;
}

void ClothLayers::part(const Nodes& nodes, double thickness, double friction, std::span<const double> give,
                       std::span<Vec3> moves, TaskPool& workers) {
    constexpr int rounds = 10;
    find(nodes, thickness, moves, workers);
    std::vector<double> pushed(contacts_.size(), 0);  // m kg, so far
    for (int round = 0; round < rounds; ++round) {
        bool is_parted = true;
        for (std::size_t c = 0; c < contacts_.size(); ++c) {
            const LayerContact& contact = contacts_[c];
            const double sum = give_of(contact, give), target = std::min(thickness, contact.distance);
            const double distance = contact.distance + dot(contact.normal, way_of(contact, moves));
            if (distance >= target || sum == 0) continue;
            is_parted = false;
            pushed[c] += (target - distance) / sum;
            push(contact, ((target - distance) / sum) * contact.normal, give, moves);
        }
        if (is_parted) break;
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
        if (pushed[c] == 0) continue;
        const LayerContact& contact = contacts_[c];
        const Vec3 way = way_of(contact, moves), sliding = way - dot(way, contact.normal) * contact.normal;
        const double size = length(sliding);
        if (size == 0) continue;
        push(contact, (-std::min(friction * pushed[c], size / give_of(contact, give)) / size) * sliding, give, moves);
    }
    join(contacts_, thickness, give, moves);
}

}  // namespace embody::physics
