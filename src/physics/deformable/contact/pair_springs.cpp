// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/pair_springs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace embody::physics::deformable {

bool HeldNodes::hold(bool is_swapped, std::span<const std::uint32_t> first,
                     std::span<const std::uint32_t> second) const {
    const auto has_any = [](const std::vector<bool>& marked, std::span<const std::uint32_t> nodes) {
        return !marked.empty() && std::ranges::any_of(nodes, [&](std::uint32_t node) { return marked[node]; });
    };
    if (are_of_one) return has_any(of_a, first) && has_any(of_a, second);
    return has_any(is_swapped ? of_b : of_a, first) || has_any(is_swapped ? of_a : of_b, second);
}

void leave_out_held(const ThinSurface& a, const ThinSurface& b, const HeldNodes& held,
                    std::vector<ThinCandidate>& candidates) {
    if (held.of_a.empty() && held.of_b.empty()) return;
    std::erase_if(candidates, [&](const ThinCandidate& candidate) {
        const ThinSurface &one = candidate.is_swapped ? b : a, &two = candidate.is_swapped ? a : b;
        using List = std::span<const std::uint32_t>;
        const List first =
            candidate.kind == ThinFeature::edge_on_edge ? List(one.edges[candidate.first]) : List(&candidate.first, 1);
        const List second = candidate.kind == ThinFeature::node_on_triangle ? List(two.triangles[candidate.second])
                                                                            : List(two.edges[candidate.second]);
        return held.hold(candidate.is_swapped, first, second);
    });
}

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
    void add_known(std::vector<Found>& kept) const;
    void add_nodes(std::span<const ThinCandidate> of_node, std::vector<Found>& kept) const;
    [[nodiscard]] bool is_held(const Found& edges, std::span<const Vec3> held_a, std::span<const Vec3> held_b) const;
};

bool PairSprings::Search::place(const ThinCandidate& candidate, Found& found) const {
    constexpr double same_place = 1e-9;  // m: features that are closer have no direction
    const auto find = [&](double ahead) {
        found = {.candidate = candidate, .points = {}, .normal = {}};
        return find_points(a.surface, b.surface, candidate, ahead, found.points) &&
               are_nearest(a.surface, b.surface, candidate, ahead, found.points);
    };
    // As they lie at the end if they go on, unless they pass through each other on that way.
    if (!find(start.h)) return false;
    found.normal = normalized(found.points.away);
    found.points.away = {};
    for (int k = 0; k < found.points.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        found.points.away +=
            found.points.weight[at] * member_of(found, k).surface.nodes->position[found.points.node[at]];
    }
    found.distance = dot(found.points.away, found.normal);
    if (!(found.distance > same_place)) {
        if (!find(0)) return false;
        found.distance = length(found.points.away);
        if (found.distance > same_place)
            found.normal = found.points.away / found.distance;
        else if (candidate.kind == ThinFeature::node_on_triangle)
            found.normal = side_of(candidate);
        else
            return false;
    }
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

// Contacts that pushed in the last substep and are not among those found, as between edges that meet at their ends:
// what held them apart goes on.
void PairSprings::Search::add_known(std::vector<Found>& kept) const {
    const auto features = [](const auto& contact) {
        return std::tuple(contact.kind, contact.is_swapped, contact.first, contact.second);
    };
    std::vector<decltype(features(ThinCandidate{}))> found;
    for (const Found& own : kept) found.push_back(features(own.candidate));
    std::ranges::sort(found);
    for (const ThinContact& known : memory) {
        if (!(known.push > 0) || std::ranges::binary_search(found, features(known))) continue;
        const ThinCandidate candidate{known.kind, known.is_swapped, known.first, known.second};
        Found own{.candidate = candidate, .points = nearest_points(a.surface, b.surface, candidate, 0), .normal = {}};
        own.distance = length(own.points.away);
        own.normal = normalized(own.points.away);
        own.memory = &known;
        if (dot(own.normal, known.normal) > start.settings.same_normal_cosine && is_near(own)) kept.push_back(own);
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
    std::array<double, 2> mass{}, own_stiffness{}, directed{};
    const bool is_self = &search.a == &search.b, is_rope = is_self && search.a.surface.triangles.empty();
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
        own_stiffness[side] += std::fabs(weight) * member.stiffness[node];
        if (is_rope) directed[side] += std::fabs(weight) * dot(found.normal, member.directed[node] * found.normal);
        compliance += weight * weight * member.surface.nodes->inverse_mass[node];
        if (!is_self && std::fabs(weight) > settings.min_load_weight) load = std::max(load, member.load[node]);
        spring.node[at] = member.first + node;
    }
    if (compliance == 0) return;
    // Of the rope alone there, across its line: along it it is far stiffer (docs/physics/ropes.md, "On round bodies").
    constexpr double self_stiffness = 6;  // times that, 1. Test: Knot.ARopeLiesOnItselfInAHeap
    spring.stiffness = is_rope ? self_stiffness * std::min(directed[0], directed[1])
                               : settings.stiffness_factor * std::max({mass[0], mass[1], load}) / (h * h);
    spring.inertia = 1 / (compliance * h * h);
    spring.normal = found.normal;
    const double gap = found.distance - search.radius;
    // Squeezed layers of one sheet: the deeper, the nearer to the stiffness of what squeezes them. Ropes, which are
    // far stiffer along than any contact, gained up to 40 times their energy by it where they met at 5 m/s.
    if (gap < 0 && is_self && !is_rope) {
        const double depth = std::min(-gap / search.radius, settings.max_stiff_depth);
        const double stiffness = std::min(own_stiffness[0], own_stiffness[1]);
        spring.stiffness =
            std::max(spring.stiffness, settings.depth_stiffness_factor * stiffness * depth / (1 - depth));
    }
    if (gap < 0) spring.returned = std::min(-settings.recovery_fraction * gap, settings.recovery_speed * h);
    spring.gap = gap < 0 ? -spring.returned : gap;
    spring.friction = search.friction;
    spring.predicts_slip = true;
    if (found.memory != nullptr) {
        spring.pull = found.memory->push * found.normal;
        spring.hold = (found.memory->stiffness / spring.stiffness) * across(found.memory->hold, found.normal);
        spring.sticks = found.memory->sticks;
    }
    springs_.push_back(spring);
    features_.push_back({found.candidate.kind,
                         found.candidate.is_swapped,
                         found.candidate.first,
                         found.candidate.second,
                         found.normal,
                         found.memory != nullptr ? found.memory->push : 0,
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
    pair_.clear();
    slots_.clear();
    start_ = start;
    std::vector<Found> kept;
    for (const ThinPair& pair : pairs) {
        const ThinMember &a = members[pair.a], &b = members[pair.b];
        const Slots slots = slots_.emplace_back(a.slot, b.slot);
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
        search.add_known(kept);
        for (const Found& found : kept) add(search, found);
        pair_.resize(springs_.size(), static_cast<std::uint32_t>(slots_.size() - 1));
    }
}

void PairSprings::add(std::span<const ThinMember> members, std::span<const ThinPair> pairs,
                      std::span<const ThinMeeting> meetings, std::span<const Vec3> moves) {
    const auto key = [&](std::uint32_t i) {
        const ThinContact& own = features_[i];
        return std::tuple(pair_[i], own.kind, own.is_swapped, own.first, own.second);
    };
    std::vector<std::uint32_t> known(springs_.size());
    std::iota(known.begin(), known.end(), 0u);
    std::ranges::stable_sort(known, {}, key);
    for (const ThinMeeting& meeting : meetings) {
        const ThinCandidate& candidate = meeting.candidate;
        bool is_known = false;
        const std::tuple own(meeting.pair, candidate.kind, candidate.is_swapped, candidate.first, candidate.second);
        for (const std::uint32_t i : std::ranges::equal_range(known, own, {}, key)) {
            if (dot(features_[i].normal, meeting.normal) < start_.settings.same_normal_cosine) continue;
            TouchSpring& spring = springs_[i];
            const double push = dot(spring.force(spring.lead(moves, {})), spring.normal);
            if (spring.acts) spring.pull = kept_push(spring, push) * spring.normal;
            is_known = true;
        }
        if (is_known) continue;
        const ThinPair& pair = pairs[meeting.pair];
        const ThinMember &a = members[pair.a], &b = members[pair.b];
        add({a, b, {}, start_, a.surface.radius + b.surface.radius, pair.friction},
            {candidate, meeting.points, meeting.normal, dot(meeting.points.away, meeting.normal)});
        pair_.resize(springs_.size(), meeting.pair);
    }
}

bool PairSprings::choose(std::span<const Vec3> moves, bool is_predicted) {
    SpringChange sum;
    for (TouchSpring& spring : springs_) choose_contact(spring, spring.lead(moves, {}), is_predicted, sum);
    return sum.change > start_.settings.change_tolerance * sum.acting;
}

void PairSprings::finish(std::span<const Vec3> moves, ThinContacts& memories) {
    const double gravity = std::max(start_.gravity, start_.settings.min_gravity);
    for (const Slots& slots : slots_) memories[slots].clear();
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        TouchSpring& spring = springs_[i];
        ThinContact& own = memories[slots_[pair_[i]]].emplace_back(features_[i]);
        const double before = std::exchange(own.push, 0);
        if (!spring.acts) continue;
        const Vec3 s = spring.lead(moves, {});
        const Vec3 force = spring.force(s);
        const double push = std::max(0.0, dot(force, spring.normal));
        own.force = force;
        own.push = kept_push(spring, push);
        // What stops a fast thing is no load: a load stays.
        own.carried = std::min(
            start_.mass, std::max(std::min(own.push, before) / gravity, start_.settings.load_memory * own.carried));
        own.hold = held_stretch(spring, spring.hold + across(s, spring.normal), push, start_.h);
        own.sticks = spring.sticks;
    }
    for (const Slots& slots : slots_) std::ranges::stable_sort(memories[slots], {}, &ThinContact::key);
}

}  // namespace embody::physics::deformable
