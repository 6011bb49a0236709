// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/crossing_guard.h"

#include <algorithm>
#include <numeric>

namespace embody::physics::deformable {

namespace {

double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(cross(b - a, c - a), d - a); }

// Whether the segment pq passes through the triangle abc.
bool passes(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
    if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
    const bool first = volume(p, q, a, b) > 0, second = volume(p, q, b, c) > 0, third = volume(p, q, c, a) > 0;
    return first == second && second == third;
}

bool has_common(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    return std::ranges::any_of(a, [&](std::uint32_t node) { return std::ranges::find(b, node) != b.end(); });
}

}  // namespace

// Whether the surfaces around the two pass through each other already: what began so, or was put there, may part.
bool CrossingGuard::is_tangled(std::uint32_t first, std::span<const std::uint32_t> of_first, std::uint32_t second,
                               std::span<const std::uint32_t> of_second) const {
    const auto passes_through = [&](std::uint32_t one, std::span<const std::uint32_t> of_one, std::uint32_t other,
                                    std::span<const std::uint32_t> of_other) {
        const ThinSurface &edges = members_[one].surface, &triangles = members_[other].surface;
        if (triangles.stars == nullptr) return false;
        const std::vector<Vec3>&x = edges.nodes->position, &y = triangles.nodes->position;
        const auto passes_near = [&](std::uint32_t e) {
            const auto& [p, q] = edges.edges[e];
            return std::ranges::any_of(of_other, [&](std::uint32_t near) {
                return std::ranges::any_of(triangles.stars->triangles(near), [&](std::uint32_t t) {
                    const auto& [a, b, c] = triangles.triangles[t];
                    if (one == other && has_common(edges.edges[e], triangles.triangles[t])) return false;
                    return passes(x[p], x[q], y[a], y[b], y[c]);
                });
            });
        };
        return std::ranges::any_of(of_one, [&](std::uint32_t node) {
            if (edges.stars != nullptr) return std::ranges::any_of(edges.stars->edges(node), passes_near);
            // Segments of a rope, by number.
            return (node > 0 && passes_near(node - 1)) || (node < edges.edges.size() && passes_near(node));
        });
    };
    return passes_through(first, of_first, second, of_second) || passes_through(second, of_second, first, of_first);
}

std::vector<ThinCandidate> CrossingGuard::candidates_of(const Pair& pair, std::span<const Vec3> moves) const {
    const ThinSurface &a = members_[pair.a].surface, &b = members_[pair.b].surface;
    const double reach = (a.radius + b.radius) / 2;  // more than first_impact() keeps
    if (pair.layers != nullptr) return pair.layers->meeting(*a.nodes, part(moves, pair.a), reach / 2, *workers_);
    std::vector<ThinCandidate> candidates;
    find_swept_candidates(a, part(moves, pair.a), b, part(moves, pair.b), reach, *workers_, candidates);
    if (pair.a == pair.b) leave_out_neighbours(a, 0, candidates);
    return candidates;
}

std::vector<ThinMeeting> CrossingGuard::find(std::span<const Vec3> moves) const {
    std::vector<ThinMeeting> meetings;
    for (std::uint32_t p = 0; p < pairs_.size(); ++p) {
        const Pair& pair = pairs_[p];
        const double distance = members_[pair.a].surface.radius + members_[pair.b].surface.radius;
        for (const ThinCandidate& candidate : candidates_of(pair, moves)) {
            const std::uint32_t first = candidate.is_swapped ? pair.b : pair.a,
                                second = candidate.is_swapped ? pair.a : pair.b;
            const ThinMember &one = members_[first], &other = members_[second];
            ThinMeeting meeting{.pair = p, .candidate = candidate};
            ThinPoints& points = meeting.points;
            const auto add = [&](auto&& nodes) {
                for (const std::uint32_t node : nodes) points.node[static_cast<std::size_t>(points.count++)] = node;
            };
            points.count = 0;
            if (candidate.kind == ThinFeature::edge_on_edge)
                add(one.surface.edges[candidate.first]);
            else
                add(std::array{candidate.first});
            points.count_first = points.count;
            if (candidate.kind == ThinFeature::node_on_triangle)
                add(other.surface.triangles[candidate.second]);
            else
                add(other.surface.edges[candidate.second]);
            MovingFeatures features{.kind = candidate.kind, .start = {}, .move = {}};
            for (int k = 0; k < points.count; ++k) {
                const auto at = static_cast<std::size_t>(k);
                const ThinMember& own = k < points.count_first ? one : other;
                features.start[at] = own.surface.nodes->position[points.node[at]];
                features.move[at] = moves[own.first + points.node[at]];
            }
            const std::optional<Impact> impact = first_impact(features, distance);
            if (!impact) continue;
            const std::span<const std::uint32_t> nodes(points.node.data(), static_cast<std::size_t>(points.count));
            const auto of_first = nodes.first(static_cast<std::size_t>(points.count_first));
            const auto of_second = nodes.subspan(of_first.size());
            if (pair.held.hold(candidate.is_swapped, of_first, of_second) ||
                is_tangled(first, of_first, second, of_second))
                continue;
            points.weight = impact->weight;
            for (std::size_t k = 0; k < nodes.size(); ++k) points.away += impact->weight[k] * features.start[k];
            meeting.normal = impact->normal;
            meetings.push_back(meeting);
        }
    }
    return meetings;
}

void CrossingGuard::hold(std::span<const double> compliance, std::span<Vec3> moves) {
    constexpr int max_passes = 20;  // from then on whole members move together
    std::vector<std::uint32_t> zone(moves.size());
    std::iota(zone.begin(), zone.end(), 0u);
    const auto root_of = [&](std::uint32_t i) {
        while (zone[i] != i) i = zone[i] = zone[zone[i]];
        return i;
    };
    bool has_joined = false;
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        a = root_of(a);
        b = root_of(b);
        has_joined |= a != b;
        zone[std::max(a, b)] = std::min(a, b);
    };
    for (int pass = 0;; ++pass) {
        const std::vector<ThinMeeting> meetings = find(moves);
        has_joined = false;
        for (const ThinMeeting& meeting : meetings) {
            const Pair& pair = pairs_[meeting.pair];
            const ThinMember &first = members_[meeting.candidate.is_swapped ? pair.b : pair.a],
                             &second = members_[meeting.candidate.is_swapped ? pair.a : pair.b];
            const ThinPoints& points = meeting.points;
            for (int k = 1; k < points.count; ++k) {
                const auto at = static_cast<std::size_t>(k);
                join(first.first + points.node[0], (k < points.count_first ? first : second).first + points.node[at]);
            }
            if (pass < max_passes) continue;
            for (const ThinMember* member : {&first, &second}) {
                for (std::uint32_t i = 1; i < member->surface.nodes->size(); ++i)
                    join(member->first, member->first + i);
            }
        }
        if (!has_joined) return;
        std::vector<double> mass(moves.size(), 0);
        std::vector<Vec3> sum(moves.size());
        std::vector<std::uint8_t> is_held(moves.size(), 0), is_joined(moves.size(), 0);
        for (std::uint32_t i = 0; i < moves.size(); ++i) {
            const std::uint32_t root = root_of(i);
            if (root != i) is_joined[root] = 1;
            if (compliance[i] == 0) {
                is_held[root] = 1;
                continue;
            }
            mass[root] += 1 / compliance[i];
            sum[root] += (1 / compliance[i]) * moves[i];
        }
        for (std::uint32_t i = 0; i < moves.size(); ++i) {
            const std::uint32_t root = root_of(i);
            if (is_joined[root] == 0 || compliance[i] == 0) continue;
            moves[i] = is_held[root] != 0 ? Vec3{} : sum[root] / mass[root];
        }
    }
}

}  // namespace embody::physics::deformable
