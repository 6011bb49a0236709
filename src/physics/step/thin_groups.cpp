// SPDX-License-Identifier: MIT
#include "physics/step/thin_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/step/solid_contact_search.h"
#include "physics/step/thin_on_solids.h"

namespace embody::physics {

namespace {

// `segments`: keeps those of a rope.
ThinSurface surface_of(const DeformableRecord& record, std::vector<std::array<std::uint32_t, 2>>& segments) {
    ThinSurface surface;
    surface.nodes = &record.nodes();
    surface.radius = record.definition.contact_radius;
    surface.friction = record.definition.friction;
    if (record.cloth) {
        const Cloth& cloth = std::get<Cloth>(record.definition.matter);
        surface.triangles = cloth.triangles;
        surface.edges = record.cloth->edges();
        surface.edge_length = record.cloth->edge_length();
        surface.radius = std::max(surface.radius, cloth.thickness / 2);
        return surface;
    }
    double sum = 0;
    segments.clear();
    const std::vector<Vec3>& nodes = surface.nodes->position;
    for (std::uint32_t s = 0; s + 1 < nodes.size(); ++s) {
        sum += length(nodes[s + 1] - nodes[s]);
        if (!record.rope->is_broken(s)) segments.push_back({s, s + 1});
    }
    surface.edges = segments;
    surface.edge_length = std::max(sum / static_cast<double>(nodes.size() - 1), 1e-6);
    return surface;
}

// What may touch of two whose bounds, as far as each may go, overlap.
std::vector<ThinCandidate> candidates_of(const WorldState& world, const DeformableRecord& a,
                                         const DeformableRecord& b) {
    std::vector<ThinCandidate> candidates;
    std::vector<std::array<std::uint32_t, 2>> segments_a, segments_b;
    find_thin_candidates(surface_of(a, segments_a), surface_of(b, segments_b), world.settings.time_step,
                         length(world.settings.gravity), *world.workers, candidates);
    return candidates;
}

bool is_thin(const DeformableRecord& record) { return !record.solid && record.definition.enabled; }

// What is wider than this has broken numbers, m: it will freeze, and nothing else is to know of it.
constexpr double widest = 1e5;

bool may_touch_others(const Bounds& bounds) {
    const Vec3 size = bounds.size();
    return size.x < widest && size.y < widest && size.z < widest;
}

// The group that member i belongs to: that of its first member.
std::uint32_t root_of(std::vector<std::uint32_t>& group, std::uint32_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
}

Substep substep_of(const WorldState& world, const DeformableRecord& record, double h, double time) {
    Substep substep{.h = h, .time = time};
    substep.gravity = record.acceleration(world.settings.gravity);
    substep.wind = world.wind();
    substep.air_density = world.settings.air_density;
    return substep;
}

void note_breaks(WorldState& world, const DeformableRecord& record) {
    const std::vector<Vec3>& nodes = record.nodes().position;
    for (const auto& [segment, tension] : record.rope->new_breaks()) {
        const DeformableHandle rope = world.deformables.handle_at(record.slot);
        world.rope_break_events.push_back(
            {rope, record.definition.user_data, segment, tension, (nodes[segment] + nodes[segment + 1]) / 2});
    }
}

/// One part of a group's substep.
class GroupPart {
public:
    GroupPart(WorldState& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h, double time);
    void advance(std::span<TouchedBody> bodies);

private:
    struct Member {
        ThinDeformable* thin = nullptr;
        Substep substep;
        std::size_t first = 0, count = 0;  // of its nodes among all
        TouchSprings touch;                // as the last solve had them
        std::vector<std::array<std::uint32_t, 2>> segments;
        [[nodiscard]] DeformableRecord& record() const { return *thin->record; }
    };
    template <class Values>
    [[nodiscard]] static auto part(Values& values, const Member& member) {
        return std::span(values).subspan(member.first, member.count);
    }
    void begin(std::span<const TouchedBody> bodies);
    bool solve(std::span<const TouchedBody> bodies);
    void gather_springs();
    bool choose_again();
    void end(std::span<TouchedBody> bodies);

    WorldState& world_;
    const ThinGroup& group_;
    double h_ = 0;
    std::vector<Member> members_;       // sheets first
    std::vector<std::uint32_t> place_;  // of the group's members among these
    std::size_t sheets_ = 0;
    PairSprings pairs_;
    std::vector<TouchSpring> springs_;  // of all
    std::vector<Vec3> moves_, given_;   // by node of all
    std::vector<BodyMove> body_moves_;
};

GroupPart::GroupPart(WorldState& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h, double time)
    : world_(world), group_(group), h_(h), place_(group.members.size()) {
    for (const bool is_sheet : {true, false}) {
        for (std::size_t i = 0; i < group.members.size(); ++i) {
            ThinDeformable& one = thin[group.members[i]];
            if ((one.record->cloth != nullptr) != is_sheet) continue;
            place_[i] = static_cast<std::uint32_t>(members_.size());
            Member& member = members_.emplace_back();
            member.thin = &one;
            member.substep = substep_of(world, *one.record, h, time);
            member.first = moves_.size();
            member.count = one.record->nodes().size();
            for (const Vec3 velocity : one.record->nodes().mean_velocity) moves_.push_back(h * velocity);
        }
        if (is_sheet) sheets_ = members_.size();
    }
}

void GroupPart::begin(std::span<const TouchedBody> bodies) {
    body_moves_.assign(bodies.size(), {});
    std::vector<ThinMember> seen(members_.size());
    for (std::size_t m = 0; m < members_.size(); ++m) {
        Member& member = members_[m];
        const ThinDeformable& thin = *member.thin;
        DeformableRecord& record = member.record();
        if (record.cloth) {
            record.cloth->set_attachments(record.definition.attachments);
            record.cloth->begin(member.substep, thin.contacts, thin.sheet_contacts, thin.attachment_bodies, bodies,
                                *world_.workers);
            member.touch = record.cloth->touch();
        } else {
            record.rope->set_attachments(record.definition.attachments);
            record.rope->set_clamps(record.definition.clamps);
            record.rope->begin(member.substep, thin.contacts, thin.segment_contacts, thin.attachment_bodies, bodies);
            member.touch = record.rope->touch();
        }
        member.touch.choose(part(moves_, member), body_moves_, true);
        seen[m] = {surface_of(record, member.segments), record.slot, static_cast<std::uint32_t>(member.first),
                   record.cloth ? record.cloth->node_stiffness() : record.rope->node_stiffness()};
    }
    std::vector<ThinPair> pairs = group_.pairs;
    for (ThinPair& pair : pairs) {
        pair.a = place_[pair.a];
        pair.b = place_[pair.b];
    }
    pairs_.begin(seen, pairs, world_.thin_contacts, h_, length(world_.settings.gravity));
    pairs_.choose(moves_, true);
}

void GroupPart::gather_springs() {
    springs_.clear();
    for (const Member& member : members_) {
        for (TouchSpring spring : member.touch.springs()) {
            for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k)
                spring.node[k] += static_cast<std::uint32_t>(member.first);
            springs_.push_back(spring);
        }
    }
    springs_.insert(springs_.end(), pairs_.springs().begin(), pairs_.springs().end());
}

// True where what acts has changed. The last solve's springs stay as they were in it, so that what one feels is what
// the other felt.
bool GroupPart::choose_again() {
    bool has_changed = false;
    std::vector<TouchSprings> touch;
    for (const Member& member : members_) {
        touch.push_back(member.touch);
        has_changed |= touch.back().choose(part(moves_, member), body_moves_, false);
    }
    PairSprings pairs = pairs_;
    has_changed |= pairs.choose(moves_, false);
    if (!has_changed) return false;
    for (std::size_t m = 0; m < members_.size(); ++m) members_[m].touch = std::move(touch[m]);
    pairs_ = std::move(pairs);
    return true;
}

// Ropes about their last moves, as in Newton's method.
bool GroupPart::solve(std::span<const TouchedBody> bodies) {
    constexpr int most_solves = 4;
    const std::vector<BodyInertia> inertias = inertias_of(bodies, h_);
    std::vector<SheetSystem> sheets;
    for (std::size_t m = 0; m < sheets_; ++m) sheets.push_back(members_[m].record().cloth->system());
    for (int solves = 1;; ++solves) {
        std::vector<LineSystem> lines;
        for (std::size_t m = sheets_; m < members_.size(); ++m)
            lines.push_back(members_[m].record().rope->linearize(members_[m].substep, part(moves_, members_[m])));
        gather_springs();
        const int rounds =
            world_.pair_solver.solve(sheets, lines, springs_, inertias, moves_, body_moves_, *world_.workers);
        if (rounds == ClothSolver::not_finite) return false;
        const bool is_over = solves == most_solves || (!choose_again() && (lines.empty() || solves > 1));
        if (is_over) break;
    }
    return std::ranges::all_of(moves_, [](Vec3 move) { return is_finite(move); }) &&
           std::ranges::all_of(body_moves_,
                               [](const BodyMove& move) { return is_finite(move.shift) && is_finite(move.turn); });
}

// Ropes once more on their own, with the forces that were found: their equations are not linear.
void GroupPart::end(std::span<TouchedBody> bodies) {
    given_.assign(moves_.size(), {});
    pairs_.finish(moves_, given_, world_.thin_contacts);
    for (Member& member : members_) {
        DeformableRecord& record = member.record();
        const std::span<const Vec3> given = part(given_, member);
        if (record.cloth) {
            record.cloth->touch() = std::move(member.touch);
            record.cloth->end(member.substep, part(moves_, member), body_moves_, given, bodies, *world_.workers);
        } else {
            record.rope->advance(member.substep, member.thin->contacts, member.thin->segment_contacts,
                                 member.thin->attachment_bodies, bodies, given);
            note_breaks(world_, record);
        }
    }
}

void GroupPart::advance(std::span<TouchedBody> bodies) {
    begin(bodies);
    if (solve(bodies)) return end(bodies);
    // What is broken freezes on its own.
    for (Member& member : members_) advance_thin(*member.thin, member.substep, bodies, *world_.workers);
}

void advance_alone(WorldState& world, ThinDeformable& thin, double h, double time, std::vector<TouchedBody>& bodies) {
    advance_thin(thin, substep_of(world, *thin.record, h, time), bodies, *world.workers);
    if (thin.record->rope) note_breaks(world, *thin.record);
}

void advance_group(WorldState& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h, double time,
                   std::vector<TouchedBody>& bodies, ThinOnSolids::Surfaces& surfaces) {
    const std::size_t first = bodies.size();
    std::vector<ThinOnSolids> solids(group.members.size(), ThinOnSolids(world, surfaces));
    for (std::size_t i = 0; i < group.members.size(); ++i) solids[i].add(thin[group.members[i]], bodies, h);
    if (group.pairs.empty()) {
        advance_alone(world, thin[group.members[0]], h, time, bodies);
    } else {
        int parts = 1;
        for (const std::uint32_t member : group.members) {
            ClothSheet* sheet = thin[member].record->cloth.get();
            if (sheet != nullptr) parts = std::max(parts, sheet->parts_of(h, *world.workers));
        }
        const PartPushes pushes(bodies);
        for (int k = 0; k < parts; ++k) {
            if (k > 0) pushes.go_on(bodies, h / parts);
            GroupPart(world, group, thin, h / parts, time + k * h / parts).advance(bodies);
        }
    }
    for (std::size_t i = 0; i < group.members.size(); ++i) solids[i].take(thin[group.members[i]], bodies, first);
    bodies.resize(first);
}

// Contacts of a pair that has parted, or of what is gone, are forgotten; sleepers keep theirs.
void forget_parted(WorldState& world, std::span<const ThinGroup> groups, std::span<const ThinDeformable> thin) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> together;
    for (const ThinGroup& group : groups) {
        for (const ThinPair& pair : group.pairs)
            together.emplace_back(thin[group.members[pair.a]].record->slot, thin[group.members[pair.b]].record->slot);
    }
    std::ranges::sort(together);
    const auto sleeps = [&](std::uint32_t slot) {
        return world.deformables.used(slot) && world.deformables.at(slot).is_asleep;
    };
    std::erase_if(world.thin_contacts, [&](const auto& memory) {
        return !std::ranges::binary_search(together, memory.first) &&
               !(sleeps(memory.first.first) && sleeps(memory.first.second));
    });
}

}  // namespace

void wake_touched_thin(WorldState& world) {
    const double h = world.settings.time_step, gravity = length(world.settings.gravity);
    const std::uint32_t count = world.deformables.slot_count();
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        if (!world.deformables.used(slot)) continue;
        DeformableRecord& sleeper = world.deformables.at(slot);
        if (!is_thin(sleeper) || !sleeper.is_asleep) continue;
        const Bounds bounds = enlarged(sleeper.bounds(), reach_of(world, sleeper));
        for (std::uint32_t other = 0; other < count && sleeper.is_asleep; ++other) {
            if (!world.deformables.used(other)) continue;
            const DeformableRecord& awake = world.deformables.at(other);
            if (!is_thin(awake) || awake.is_asleep || !may_collide(awake.definition, sleeper.definition)) continue;
            const Bounds reach = enlarged(awake.bounds(), reach_of(world, awake));
            if (!overlaps(bounds, reach) || !may_touch_others(reach)) continue;
            std::vector<std::array<std::uint32_t, 2>> segments_a, segments_b;
            const ThinSurface a = surface_of(awake, segments_a), b = surface_of(sleeper, segments_b);
            if (!will_touch(a, b, candidates_of(world, awake, sleeper), h, gravity)) continue;
            sleeper.is_asleep = false;
            sleeper.quiet_time = 0;
        }
    }
}

std::vector<ThinGroup> find_thin_groups(WorldState& world, std::span<const ThinDeformable> thin) {
    std::vector<std::uint32_t> group(thin.size());
    std::iota(group.begin(), group.end(), 0u);
    std::vector<Bounds> bounds;
    for (const ThinDeformable& one : thin)
        bounds.push_back(enlarged(one.record->bounds(), reach_of(world, *one.record)));
    std::vector<ThinPair> pairs;
    for (std::uint32_t a = 0; a < thin.size(); ++a) {
        for (std::uint32_t b = a + 1; b < thin.size(); ++b) {
            const DeformableRecord &one = *thin[a].record, &two = *thin[b].record;
            if (!overlaps(bounds[a], bounds[b]) || !may_collide(one.definition, two.definition)) continue;
            if (!may_touch_others(bounds[a]) || !may_touch_others(bounds[b])) continue;
            ThinPair pair{a, b, candidates_of(world, one, two)};
            if (pair.candidates.empty()) continue;
            pairs.push_back(std::move(pair));
            const std::uint32_t i = root_of(group, a), k = root_of(group, b);
            group[std::max(i, k)] = std::min(i, k);
        }
    }
    std::vector<ThinGroup> groups;
    std::vector<std::uint32_t> number(thin.size()), place(thin.size());  // of the group; in it
    for (std::uint32_t i = 0; i < thin.size(); ++i) {
        const std::uint32_t root = root_of(group, i);
        if (root == i) {
            number[i] = static_cast<std::uint32_t>(groups.size());
            groups.emplace_back();
        }
        ThinGroup& own = groups[number[root]];
        number[i] = number[root];
        place[i] = static_cast<std::uint32_t>(own.members.size());
        own.members.push_back(i);
        own.has_rope |= thin[i].record->rope != nullptr;
    }
    for (ThinPair& pair : pairs) {
        ThinGroup& own = groups[number[pair.a]];
        own.pairs.push_back({place[pair.a], place[pair.b], std::move(pair.candidates)});
    }
    forget_parted(world, groups, thin);
    return groups;
}

void advance_thin_groups(WorldState& world, std::span<const ThinGroup> groups, std::span<ThinDeformable> thin,
                         std::vector<TouchedBody>& bodies, int k) {
    const int substeps = world.settings.deformable_substeps;
    const double step = world.settings.time_step, h = step / substeps;
    ThinOnSolids::Surfaces surfaces;
    for (const ThinGroup& group : groups) {
        if (group.has_rope)
            advance_group(world, group, thin, h, (k - 1) * h, bodies, surfaces);
        else if (k == substeps)
            advance_group(world, group, thin, step, 0, bodies, surfaces);
    }
}

void forget_thin_contacts(WorldState& world, std::uint32_t slot) {
    std::erase_if(world.thin_contacts,
                  [&](const auto& memory) { return memory.first.first == slot || memory.first.second == slot; });
}

}  // namespace embody::physics
