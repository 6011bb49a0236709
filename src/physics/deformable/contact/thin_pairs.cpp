// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/thin_pairs.h"

#include <algorithm>
#include <utility>

#include "physics/deformable/contact/box_grid.h"
#include "physics/deformable/contact/nearest_points.h"

namespace embody::physics::deformable {

namespace {

// Features with the boxes that they sweep.
struct SweptFeatures {
    std::vector<std::uint32_t> feature;
    std::vector<Bounds> box;
    double usual_size = 0;  // m
};

class Sweep {
public:
    // `motion`: of the whole, left out: features that move together do not meet. `margin`: around each node, m.
    Sweep(const ThinSurface& surface, std::span<const Vec3> moves, Vec3 motion, double margin) : surface_(surface) {
        const Nodes& nodes = *surface.nodes;
        boxes_.reserve(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Vec3 start = nodes.position[i], end = start + moves[i] - motion;
            boxes_.push_back(enlarged(Bounds{min(start, end), max(start, end)}, margin));
            bounds_.add(boxes_.back());
        }
    }
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] SweptFeatures nodes_in(const Bounds& region) const {
        SweptFeatures found{.feature = {}, .box = {}, .usual_size = surface_.edge_length};
        for (std::uint32_t i = 0; i < boxes_.size(); ++i) add(i, boxes_[i], region, found);
        return found;
    }
    template <std::size_t corners>
    [[nodiscard]] SweptFeatures joined_in(std::span<const std::array<std::uint32_t, corners>> features,
                                          const Bounds& region) const {
        SweptFeatures found{.feature = {}, .box = {}, .usual_size = surface_.edge_length};
        for (std::uint32_t f = 0; f < features.size(); ++f) {
            Bounds box;
            for (const std::uint32_t node : features[f]) box.add(boxes_[node]);
            add(f, box, region, found);
        }
        return found;
    }

private:
    static void add(std::uint32_t feature, const Bounds& box, const Bounds& region, SweptFeatures& found) {
        if (!overlaps(box, region)) return;
        found.feature.push_back(feature);
        found.box.push_back(box);
    }
    const ThinSurface& surface_;
    std::vector<Bounds> boxes_;  // by node
    Bounds bounds_;
};

void match(const SweptFeatures& first, const SweptFeatures& second, ThinFeature kind, bool is_swapped,
           TaskPool& workers, std::vector<ThinCandidate>& candidates) {
    if (first.box.empty() || second.box.empty()) return;
    BoxGrid grid;
    grid.fill(second.box, second.usual_size);
    std::vector<std::vector<ThinCandidate>> found(static_cast<std::size_t>(std::max(1, workers.workers())));
    parallel_for(workers, first.box.size(), first.box.size() >= 1000, [&](int worker, IndexRange range) {
        std::vector<ThinCandidate>& own = found[static_cast<std::size_t>(worker)];
        std::vector<std::uint32_t> others;
        for (std::size_t i = range.first; i < range.last; ++i) {
            others.clear();
            grid.visit(first.box[i], [&](std::uint32_t k) {
                if (overlaps(first.box[i], second.box[k])) others.push_back(second.feature[k]);
            });
            // Whatever the order of the cells.
            std::ranges::sort(others);
            others.erase(std::unique(others.begin(), others.end()), others.end());
            for (const std::uint32_t other : others) own.push_back({kind, is_swapped, first.feature[i], other});
        }
    });
    for (const auto& own : found) candidates.insert(candidates.end(), own.begin(), own.end());
}

}  // namespace

void find_swept_candidates(const ThinSurface& a, std::span<const Vec3> moves_a, const ThinSurface& b,
                           std::span<const Vec3> moves_b, double reach, TaskPool& workers,
                           std::vector<ThinCandidate>& candidates) {
    Vec3 motion;
    for (const Vec3 move : moves_a) motion += move / static_cast<double>(moves_a.size());
    const Sweep sweep_a(a, moves_a, motion, reach / 2), sweep_b(b, moves_b, motion, reach / 2);
    const Bounds region{max(sweep_a.bounds().lower, sweep_b.bounds().lower),
                        min(sweep_a.bounds().upper, sweep_b.bounds().upper)};
    if (region.is_empty()) return;
    const SweptFeatures edges_a = sweep_a.joined_in(a.edges, region), edges_b = sweep_b.joined_in(b.edges, region);
    const SweptFeatures nodes_a = sweep_a.nodes_in(region), nodes_b = sweep_b.nodes_in(region);
    if (!b.triangles.empty())
        match(nodes_a, sweep_b.joined_in(b.triangles, region), ThinFeature::node_on_triangle, false, workers,
              candidates);
    if (!a.triangles.empty())
        match(nodes_b, sweep_a.joined_in(a.triangles, region), ThinFeature::node_on_triangle, true, workers,
              candidates);
    // On a sheet an edge belongs to a triangle.
    if (b.triangles.empty()) match(nodes_a, edges_b, ThinFeature::node_on_edge, false, workers, candidates);
    if (a.triangles.empty()) match(nodes_b, edges_a, ThinFeature::node_on_edge, true, workers, candidates);
    match(edges_a, edges_b, ThinFeature::edge_on_edge, false, workers, candidates);
}

void find_thin_candidates(const ThinSurface& a, const ThinSurface& b, double time_step, double gravity,
                          TaskPool& workers, std::vector<ThinCandidate>& candidates) {
    const auto moves_of = [&](const ThinSurface& surface) {
        std::vector<Vec3> moves;
        for (const Vec3 velocity : surface.nodes->mean_velocity) moves.push_back(time_step * velocity);
        return moves;
    };
    const double reach = a.radius + b.radius + 2 * gravity * time_step * time_step;
    find_swept_candidates(a, moves_of(a), b, moves_of(b), reach, workers, candidates);
}

void leave_out_neighbours(const ThinSurface& rope, double distance, std::vector<ThinCandidate>& candidates) {
    const double nearest = std::max(1.0, distance / rope.edge_length);  // segments
    std::erase_if(candidates, [&](const ThinCandidate& candidate) {
        const auto [first, second] = std::pair<double, double>(candidate.first, candidate.second);
        if (candidate.kind == ThinFeature::edge_on_edge) return second - first - 1 < nearest;
        return candidate.is_swapped || (first <= second ? second - first : first - second - 1) < nearest;
    });
}

ThinPoints nearest_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead) {
    const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
    const auto x = [&](std::uint32_t node) { return first.nodes->ahead(node, ahead); };
    const auto y = [&](std::uint32_t node) { return second.nodes->ahead(node, ahead); };
    ThinPoints points;
    if (candidate.kind == ThinFeature::node_on_triangle) {
        const auto [p, q, r] = second.triangles[candidate.second];
        const auto w = nearest_weights(x(candidate.first), y(p), y(q), y(r));
        points = {{candidate.first, p, q, r}, {1, -w[0], -w[1], -w[2]}, 1, 4, {}};
    } else if (candidate.kind == ThinFeature::node_on_edge) {
        const auto [p, q] = second.edges[candidate.second];
        const double t = nearest_along(x(candidate.first), y(p), y(q));
        points = {{candidate.first, p, q, 0}, {1, t - 1, -t, 0}, 1, 3, {}};
    } else {
        const auto [p, q] = first.edges[candidate.first];
        const auto [r, s] = second.edges[candidate.second];
        const auto [t, u] = nearest_between(x(p), x(q), y(r), y(s));
        points = {{p, q, r, s}, {1 - t, t, u - 1, -u}, 2, 4, {}};
    }
    for (int k = 0; k < points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        points.away += points.weight[at] * (k < points.count_first ? x(points.node[at]) : y(points.node[at]));
    }
    return points;
}

bool find_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead,
                 ThinPoints& points) {
    if (candidate.kind == ThinFeature::edge_on_edge) {
        const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
        const auto x = [&](std::uint32_t node) { return first.nodes->ahead(node, ahead); };
        const auto y = [&](std::uint32_t node) { return second.nodes->ahead(node, ahead); };
        const auto [p, q] = first.edges[candidate.first];
        const auto [r, s] = second.edges[candidate.second];
        double t = 0, u = 0;
        if (!nearest_inside(x(p), x(q), y(r), y(s), t, u)) return false;
    }
    points = nearest_points(a, b, candidate, ahead);
    return true;
}

namespace {

// Whether a sheet goes nowhere from a point of it in the direction `away`: it lies with these weights between nodes.
bool is_nearest_around(const ThinSurface& sheet, std::span<const std::uint32_t> nodes, std::span<const double> weights,
                       double ahead, Vec3 away) {
    if (sheet.stars == nullptr) return true;  // a rope
    constexpr double rounding = 1e-6;         // of a cosine
    const auto x = [&](std::uint32_t node) { return sheet.nodes->ahead(node, ahead); };
    const auto goes_there = [&](Vec3 direction) {
        return dot(away, direction) > rounding * length(away) * length(direction);
    };
    std::array<std::uint32_t, 3> of{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (weights[k] != 0) of[count++] = nodes[k];
    }
    if (count == 3) return true;
    if (count == 1) {
        return std::ranges::none_of(sheet.stars->edges(of[0]), [&](std::uint32_t e) {
            const auto [p, q] = sheet.edges[e];
            return goes_there(x(p == of[0] ? q : p) - x(of[0]));
        });
    }
    const Vec3 along = normalized(x(of[1]) - x(of[0]));
    return std::ranges::none_of(sheet.stars->triangles(of[0]), [&](std::uint32_t t) {
        const auto& triangle = sheet.triangles[t];
        if (std::ranges::find(triangle, of[1]) == triangle.end()) return false;
        const auto third =
            *std::ranges::find_if(triangle, [&](std::uint32_t node) { return node != of[0] && node != of[1]; });
        return goes_there(across(x(third) - x(of[0]), along));
    });
}

// The same of a node of a rope.
bool is_nearest_along(const ThinSurface& rope, std::uint32_t node, double ahead, Vec3 away) {
    const auto x = [&](std::uint32_t i) { return rope.nodes->ahead(i, ahead); };
    const bool goes_back = node > 0 && dot(away, x(node - 1) - x(node)) > 0;
    return !goes_back && !(node + 1 < rope.nodes->size() && dot(away, x(node + 1) - x(node)) > 0);
}

}  // namespace

bool are_nearest(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, double ahead,
                 const ThinPoints& points) {
    const std::span<const std::uint32_t> nodes(points.node.data(), static_cast<std::size_t>(points.count));
    const std::span<const double> weights(points.weight.data(), nodes.size());
    const auto first = static_cast<std::size_t>(points.count_first);
    const ThinSurface &one = candidate.is_swapped ? b : a, &two = candidate.is_swapped ? a : b;
    if (candidate.kind == ThinFeature::node_on_edge && &one == &two) {
        if (!is_nearest_along(one, nodes[0], ahead, -points.away)) return false;
        for (std::size_t k = first; k < nodes.size(); ++k) {
            if (weights[k] == -1 && !is_nearest_along(two, nodes[k], ahead, points.away)) return false;
        }
        return true;
    }
    if (candidate.kind == ThinFeature::edge_on_edge) {
        // What a rope presses on a sheet with its segments is borne by all edges below: by its nodes alone it sank in.
        if (one.stars == nullptr || two.stars == nullptr) return true;
        if (!is_nearest_around(one, nodes.first(first), weights.first(first), ahead, -points.away)) return false;
    }
    return is_nearest_around(two, nodes.subspan(first), weights.subspan(first), ahead, points.away);
}

bool will_touch(const ThinSurface& a, const ThinSurface& b, std::span<const ThinCandidate> candidates, double time_step,
                double gravity) {
    return std::ranges::any_of(candidates, [&](const ThinCandidate& candidate) {
        const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
        ThinPoints points;
        if (!find_points(a, b, candidate, 0, points)) return false;
        Vec3 velocity;
        for (int k = 0; k < points.count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const ThinSurface& surface = k < points.count_first ? first : second;
            velocity += points.weight[at] * surface.nodes->mean_velocity[points.node[at]];
        }
        const double closing = dot(velocity, normalized(points.away));
        return length(points.away) + (closing - gravity * time_step) * time_step < a.radius + b.radius;
    });
}

}  // namespace embody::physics::deformable
