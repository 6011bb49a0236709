// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/thin_pairs.h"

#include <algorithm>

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

ThinPoints nearest_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate) {
    const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
    const std::vector<Vec3>&x = first.nodes->position, &y = second.nodes->position;
    ThinPoints points;
    if (candidate.kind == ThinFeature::node_on_triangle) {
        const auto [p, q, r] = second.triangles[candidate.second];
        const auto w = nearest_weights(x[candidate.first], y[p], y[q], y[r]);
        points = {{candidate.first, p, q, r}, {1, -w[0], -w[1], -w[2]}, 1, 4, {}};
    } else if (candidate.kind == ThinFeature::node_on_edge) {
        const auto [p, q] = second.edges[candidate.second];
        const double t = nearest_along(x[candidate.first], y[p], y[q]);
        points = {{candidate.first, p, q, 0}, {1, t - 1, -t, 0}, 1, 3, {}};
    } else {
        const auto [p, q] = first.edges[candidate.first];
        const auto [r, s] = second.edges[candidate.second];
        const auto [t, u] = nearest_between(x[p], x[q], y[r], y[s]);
        points = {{p, q, r, s}, {1 - t, t, u - 1, -u}, 2, 4, {}};
    }
    for (int k = 0; k < points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        points.away += points.weight[at] * (k < points.count_first ? x : y)[points.node[at]];
    }
    return points;
}

bool find_points(const ThinSurface& a, const ThinSurface& b, const ThinCandidate& candidate, ThinPoints& points) {
    if (candidate.kind == ThinFeature::edge_on_edge) {
        const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
        const std::vector<Vec3>&x = first.nodes->position, &y = second.nodes->position;
        const auto [p, q] = first.edges[candidate.first];
        const auto [r, s] = second.edges[candidate.second];
        double t = 0, u = 0;
        if (!nearest_inside(x[p], x[q], y[r], y[s], t, u)) return false;
    }
    points = nearest_points(a, b, candidate);
    return true;
}

bool will_touch(const ThinSurface& a, const ThinSurface& b, std::span<const ThinCandidate> candidates, double time_step,
                double gravity) {
    return std::ranges::any_of(candidates, [&](const ThinCandidate& candidate) {
        const ThinSurface &first = candidate.is_swapped ? b : a, &second = candidate.is_swapped ? a : b;
        ThinPoints points;
        if (!find_points(a, b, candidate, points)) return false;
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
