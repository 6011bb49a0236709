// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/pair_springs.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::deformable {

struct PairSprings::Found {
    ThinCandidate candidate;
    ThinPoints points;
    Vec3 normal;                          // from the second to the first
    double distance = 0;                  // along the normal, m: below zero where the first has come to the other side
    const ThinContact* memory = nullptr;  // of forces

    [[nodiscard]] auto key() const { return std::tuple(candidate.kind, candidate.is_swapped, candidate.first); }
};

// Of a pair in this substep.
struct PairSprings::Search {
    const ThinMember &a, &b;
    std::span<const ThinContact> memory;
    const Start& start;
    double radius = 0;  // of both together
    PairFriction friction;

    [[nodiscard]] const ThinMember& first(const ThinCandidate& candidate) const { return candidate.is_swapped ? b : a; }
    [[nodiscard]] const ThinMember& second(const ThinCandidate& candidate) const {
        return candidate.is_swapped ? a : b;
    }
    [[nodiscard]] const ThinMember& member_of(const Found& found, int k) const {
        return k < found.points.count_first ? first(found.candidate) : second(found.candidate);
    }
    [[nodiscard]] bool place(const ThinCandidate& candidate, Found& found) const;
    [[nodiscard]] Vec3 side_of(const ThinCandidate& candidate) const;
    [[nodiscard]] bool is_next_to(const ThinContact& memory, const ThinCandidate& candidate) const;
    void recall(Found& found) const;
    [[nodiscard]] bool is_near(const Found& found) const;
    void add_nodes(std::span<const ThinCandidate> of_node, std::vector<Found>& kept) const;
    [[nodiscard]] bool is_held(const Found& edges, std::span<const Vec3> held_a, std::span<const Vec3> held_b) const;
};

bool PairSprings::Search::place(const ThinCandidate& candidate, Found& found) const {
    found = {.candidate = candidate, .points = {}, .normal = {}};
    if (!find_points(a.surface, b.surface, candidate, found.points)) return false;
    constexpr double same_place = 1e-9;  // m: features that are closer have no direction
    found.distance = length(found.points.away);
    if (found.distance > same_place)
        found.normal = found.points.away / found.distance;
    else if (candidate.kind == ThinFeature::node_on_triangle)
        found.normal = side_of(candidate);
    else
        return false;
    recall(found);
    return is_near(found);
}

// Of two in the same place, as when a sheet is copied, the first of the pair is the upper one.
Vec3 PairSprings::Search::side_of(const ThinCandidate& candidate) const {
    const ThinSurface& surface = second(candidate).surface;
    const auto [p, q, r] = surface.triangles[candidate.second];
    const std::vector<Vec3>& x = surface.nodes->position;
    return normalized((candidate.is_swapped ? -1.0 : 1.0) * cross(x[q] - x[p], x[r] - x[p]), {0, 1, 0});
}

// Whether a feature on the wrong side has come through there: in a stack of one sheet's layers a node is above one and
// below another.
bool PairSprings::Search::is_next_to(const ThinContact& known, const ThinCandidate& candidate) const {
    if (&a != &b || known.kind != ThinFeature::node_on_triangle) return true;
    const auto& triangles = a.surface.triangles;
    return std::ranges::any_of(triangles[candidate.second], [&](std::uint32_t node) {
        return std::ranges::find(triangles[known.second], node) != triangles[known.second].end();
    });
}

// A sheet has no inside: the side on which a feature is must be remembered.
void PairSprings::Search::recall(Found& found) const {
    const ThinContactSettings& settings = start.settings;
    const auto is_before = [](const ThinContact& m, const auto& key) { return m.key() < key; };
    const ThinContact* nearest = nullptr;
    double most = settings.same_side_cosine;
    for (auto at = std::lower_bound(memory.begin(), memory.end(), found.key(), is_before);
         at != memory.end() && at->key() == found.key(); ++at) {
        if (found.candidate.kind == ThinFeature::edge_on_edge && at->second != found.candidate.second) continue;
        const double cosine = std::fabs(dot(at->normal, found.normal));
        if (cosine < most || !is_next_to(*at, found.candidate)) continue;
        most = cosine;
        nearest = &*at;
    }
    if (nearest == nullptr) return;
    if (dot(nearest->normal, found.normal) < 0) {
        if (found.distance > settings.max_wrong_side_radii * radius) return;
        found.normal = -found.normal;
        found.distance = -found.distance;
    }
    if (most > settings.same_normal_cosine) found.memory = nearest;
}

// Whether it may touch within the substep: by its own speed and gravity.
bool PairSprings::Search::is_near(const Found& found) const {
    Vec3 velocity;
    for (int k = 0; k < found.points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        velocity += found.points.weight[at] * member_of(found, k).surface.nodes->mean_velocity[found.points.node[at]];
    }
    return found.distance - radius < (length(velocity) + start.gravity * start.h) * start.h + radius;
}

// A node touches the nearest of the triangles, and others in another direction.
void PairSprings::Search::add_nodes(std::span<const ThinCandidate> of_node, std::vector<Found>& kept) const {
    const double other_direction = start.settings.other_normal_cosine;
    std::vector<Found> near;
    for (const ThinCandidate& candidate : of_node) {
        Found found;
        if (place(candidate, found)) near.push_back(found);
    }
    std::ranges::stable_sort(near, {}, [](const Found& found) { return std::fabs(found.distance); });
    const std::size_t first = kept.size();
    for (const Found& found : near) {
        const auto is_same_direction = [&](const Found& other) {
            return dot(other.normal, found.normal) > other_direction;
        };
        if (std::none_of(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(), is_same_direction))
            kept.push_back(found);
    }
}

// Of two sheets: whether both ends of either edge touch the other sheet from the same side.
bool PairSprings::Search::is_held(const Found& edges, std::span<const Vec3> held_a,
                                  std::span<const Vec3> held_b) const {
    const double same_direction = start.settings.held_edge_cosine;
    const auto holds = [&](Vec3 normal) { return dot(normal, edges.normal) > same_direction; };
    const auto& node = edges.points.node;
    return holds(held_a[node[0]]) || holds(held_a[node[1]]) || holds(-held_b[node[2]]) || holds(-held_b[node[3]]);
}

void PairSprings::add(const Search& search, const Found& found) {
    const ThinContactSettings& settings = search.start.settings;
    const double h = search.start.h;
    TouchSpring spring{.node = found.points.node, .weight = found.points.weight, .count = found.points.count};
    std::array<double, 2> mass{};
    const bool is_self = &search.a == &search.b;
    Vec3 place;
    double compliance = 0, load = found.memory != nullptr && !is_self ? found.memory->carried : 0;
    for (int k = 0; k < found.points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const ThinMember& member = search.member_of(found, k);
        const std::uint32_t node = found.points.node[at];
        const double weight = found.points.weight[at];
        const std::size_t side = k < found.points.count_first ? 0 : 1;
        if (side == 0) place += weight * member.surface.nodes->position[node];
        mass[side] += std::fabs(weight) * member.surface.nodes->mass[node];
        compliance += weight * weight * member.surface.nodes->inverse_mass[node];
        if (std::fabs(weight) > settings.min_load_weight) load = std::max(load, member.load[node]);
        spring.node[at] = member.first + node;
    }
    if (compliance == 0) return;
    spring.stiffness = settings.stiffness_factor * std::max({mass[0], mass[1], load}) / (h * h);
    spring.inertia = 1 / (compliance * h * h);
    spring.normal = found.normal;
    const double gap = found.distance - search.radius;
    if (gap < 0) spring.returned = std::min(-settings.recovery_fraction * gap, settings.recovery_speed * h);
    spring.gap = gap < 0 ? -spring.returned : gap;
    spring.friction = search.friction;
    if (found.memory != nullptr) {
        // Layers that something holds in each other must not push harder and harder: the deeper they are, the more
        // force they forget.
        const double kept = is_self ? std::clamp(1 + gap / (settings.memory_depth * search.radius), 0.0, 1.0) : 1;
        spring.pull = kept * found.memory->push * found.normal;
        spring.hold = (found.memory->stiffness / spring.stiffness) * across(found.memory->hold, found.normal);
        spring.sticks = found.memory->sticks;
    }
    springs_.push_back(spring);
    features_.push_back({found.candidate.kind,
                         found.candidate.is_swapped,
                         found.candidate.first,
                         found.candidate.second,
                         found.normal,
                         0,
                         {},
                         true,
                         spring.stiffness,
                         found.memory != nullptr ? found.memory->carried : 0,
                         place - search.first(found.candidate).surface.radius * found.normal,
                         {}});
}

void PairSprings::begin(std::span<const ThinMember> members, std::span<const ThinPair> pairs,
                        const ThinContacts& memories, const Start& start) {
    springs_.clear();
    features_.clear();
    last_of_.clear();
    start_ = start;
    std::vector<Found> kept;
    for (const ThinPair& pair : pairs) {
        const ThinMember &a = members[pair.a], &b = members[pair.b];
        const Slots slots{a.slot, b.slot};
        const auto known = memories.find(slots);
        const Search search{a,
                            b,
                            known == memories.end() ? std::span<const ThinContact>() : known->second,
                            start_,
                            a.surface.radius + b.surface.radius,
                            pair.friction};
        kept.clear();
        std::vector<Vec3> held(a.surface.nodes->size()), held_by_b(pair.a == pair.b ? 0 : b.surface.nodes->size());
        std::vector<Vec3>& held_b = pair.a == pair.b ? held : held_by_b;
        const bool are_sheets = !a.surface.triangles.empty() && !b.surface.triangles.empty();
        const std::span<const ThinCandidate> all = pair.candidates;
        for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
            const auto is_same = [&](const ThinCandidate& c) {
                return c.kind == all[first].kind && c.is_swapped == all[first].is_swapped &&
                       c.first == all[first].first;
            };
            while (last < all.size() && is_same(all[last])) ++last;
            const auto run = all.subspan(first, last - first);
            const std::size_t before = kept.size();
            if (all[first].kind != ThinFeature::edge_on_edge) {
                search.add_nodes(run, kept);
                if (kept.size() > before) (run[0].is_swapped ? held_b : held)[run[0].first] = kept[before].normal;
                continue;
            }
            for (const ThinCandidate& candidate : run) {
                Found found;
                if (search.place(candidate, found) && !(are_sheets && search.is_held(found, held, held_b)))
                    kept.push_back(found);
            }
        }
        for (const Found& found : kept) add(search, found);
        last_of_.emplace_back(slots, springs_.size());
    }
}

bool PairSprings::choose(std::span<const Vec3> moves, bool is_predicted) {
    SpringChange sum;
    for (TouchSpring& spring : springs_) choose_contact(spring, spring.lead(moves, {}), is_predicted, sum);
    return sum.change > start_.settings.change_tolerance * sum.acting;
}

void PairSprings::finish(std::span<const Vec3> moves, std::span<Vec3> given, ThinContacts& memories) {
    const double gravity = std::max(start_.gravity, start_.settings.min_gravity);
    std::size_t i = 0;
    for (const auto& [slots, last] : last_of_) {
        std::vector<ThinContact>& memory = memories[slots];
        memory.clear();
        for (; i < last; ++i) {
            TouchSpring& spring = springs_[i];
            ThinContact& own = memory.emplace_back(features_[i]);
            if (!spring.acts) continue;
            const Vec3 s = spring.lead(moves, {});
            const Vec3 force = spring.force(s);
            const double push = std::max(0.0, dot(force, spring.normal));
            own.force = force;
            own.push = kept_push(spring, push);
            own.carried = std::max(own.push / gravity, start_.settings.load_memory * own.carried);
            own.hold = held_stretch(spring, spring.hold + across(s, spring.normal), push, start_.h);
            own.sticks = spring.sticks;
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
                given[spring.node[k]] += spring.weight[k] * force;
        }
        std::ranges::stable_sort(memory, {}, &ThinContact::key);
    }
}

}  // namespace embody::physics::deformable
