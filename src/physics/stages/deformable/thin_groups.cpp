// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/thin_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/solid_contact_search.h"
#include "physics/stages/deformable/solid_ties.h"
#include "physics/stages/deformable/thin_group_part.h"
#include "physics/stages/deformable/thin_on_solids.h"
#include "physics/state/deformable_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// The nodes of `own` that are held at the other: by a tie, or by anchors on one body that are nearer to each other than
// the distance that the two keep, m. None: empty.
std::vector<bool> held_nodes(const DeformableAccess& world, const DeformableRecord& own, const DeformableRecord& other,
                             double distance) {
    std::vector<bool> is_held;
    const auto hold = [&](std::uint32_t node) {
        is_held.resize(own.nodes().size(), false);
        is_held[node] = true;
    };
    for (const Tie& tie : own.definition.ties) {
        if (world.deformables.records.find(tie.other) == &other) hold(tie.node);
    }
    for (const Tie& tie : other.definition.ties) {
        if (world.deformables.records.find(tie.other) != &own) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            if (tie.weight[k] > 0) hold(tie.other_nodes[k]);
        }
    }
    for (const Attachment& attachment : own.definition.attachments) {
        const auto is_near = [&](const Attachment& of_other) {
            return of_other.body == attachment.body && length(of_other.anchor - attachment.anchor) < distance;
        };
        if (std::ranges::any_of(other.definition.attachments, is_near)) hold(attachment.node);
    }
    return is_held;
}

// Acceleration by gravity and its constant force, m/s².
double pull_on(const DeformableAccess& world, const DeformableRecord& record) {
    return length(record.acceleration(world.settings.gravity));
}

// Of two members whose bounds, extended by their travel, overlap: sets what is held together and the candidates.
void find_candidates(const DeformableAccess& world, const DeformableRecord& a, const DeformableRecord& b,
                     ThinPair& pair) {
    std::vector<std::array<std::uint32_t, 2>> segments_a, segments_b;
    const ThinSurface on_a = surface_of(a, segments_a), on_b = surface_of(b, segments_b);
    find_thin_candidates(on_a, on_b, world.settings.time_step, std::max(pull_on(world, a), pull_on(world, b)),
                         world.workers, pair.candidates);
    const double distance = on_a.radius + on_b.radius;
    pair.held = {held_nodes(world, a, b, distance), held_nodes(world, b, a, distance)};
    leave_out_held(on_a, on_b, pair.held, pair.candidates);
}

// m: a wider member has broken numbers; it will freeze, and others ignore it.
constexpr double max_finite_size = 1e5;

bool may_touch_others(const Bounds& bounds) {
    const Vec3 size = bounds.size();
    return size.x < max_finite_size && size.y < max_finite_size && size.z < max_finite_size;
}

// Whether a rope may touch a body that moves: what a solve that does not converge leaves of the rope's contacts with
// itself would throw it away.
bool may_touch_moving_body(const ThinDeformable& rope, std::span<const TouchedBody> bodies) {
    const auto moves = [&](const NodeContact& contact) { return bodies[contact.body].is_dynamic; };
    return std::ranges::any_of(rope.contacts, moves) ||
           std::ranges::any_of(rope.segment_contacts,
                               [&](const SegmentContact& contact) { return moves(contact.plane); });
}

// A rope that may touch itself, as a member of a group that has no other.
void add_own_pair(const DeformableAccess& world, const DeformableRecord& rope, ThinGroup& group) {
    if (!may_touch_others(rope.bounds())) return;
    std::vector<std::array<std::uint32_t, 2>> segments;
    const ThinSurface surface = surface_of(rope, segments);
    const Material& material = rope.definition.material;
    ThinPair own{.friction = friction_between(material, material, world.rigid.surface_pairs)};
    find_thin_candidates(surface, surface, world.settings.time_step, pull_on(world, rope), world.workers,
                         own.candidates);
    // Half a turn about its own thickness is as near as a bend brings two places together.
    constexpr double pi = 3.14159265358979323846;  // rad
    leave_out_neighbours(surface, std::max(2 * surface.edge_length, pi * surface.radius), own.candidates);
    own.held.are_of_one = true;
    own.held.of_a.resize(rope.nodes().size(), false);
    for (const Attachment& attachment : rope.definition.attachments) own.held.of_a[attachment.node] = true;
    leave_out_held(surface, surface, own.held, own.candidates);
    if (!own.candidates.empty()) group.pairs.push_back(std::move(own));
}

bool is_thin(const DeformableRecord& record) { return !record.solid() && record.definition.enabled; }

// The group that member i belongs to: that of its first member.
std::uint32_t root_of(std::vector<std::uint32_t>& group, std::uint32_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
}

// In parts where things meet fast or are stretched far: half as long until they can be solved, then longer again.
void advance_in_parts(const DeformableAccess& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h,
                      double time, std::vector<TouchedBody>& bodies) {
    // Counted in the shortest: summed up in seconds, their rounding would be left over as one more part.
    const int count = world.settings.solver.deformable.cloth.max_parts;
    int done = 0, size = count;
    while (done < count) {
        const double part = h * size / count;
        const std::vector<TouchedBody> before = bodies;
        for (TouchedBody& body : bodies) {
            if (done > 0)
                body.enter_part(part);
            else if (size < count)
                body.return_to_part(h, part);
        }
        if (ThinGroupPart(world, group, thin, part, time + h * done / count).advance(bodies, size == 1)) {
            done += size;
            size = std::min(2 * size, count - done);
        } else {
            bodies = before;
            size /= 2;
        }
    }
}

void advance_group(const DeformableAccess& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h,
                   double time, std::vector<TouchedBody>& bodies, ThinOnSolids::Surfaces& surfaces) {
    const std::size_t first = bodies.size();
    std::vector<ThinOnSolids> solids(group.members.size(), ThinOnSolids(world, surfaces));
    std::vector<SolidTies> ties(group.members.size(), SolidTies(world));
    for (std::size_t i = 0; i < group.members.size(); ++i) {
        solids[i].add(thin[group.members[i]], bodies, h);
        ties[i].add(thin[group.members[i]], bodies, h);
    }
    ThinDeformable& first_member = thin[group.members[0]];
    if (group.members.size() == 1 && first_member.record->rope() && group.pairs.empty()) {
        first_member.record->begin_substep(h, world.settings.gravity, true);
        advance_rope(first_member, substep_of(world, *first_member.record, h, time), bodies);
        note_breaks(world, *first_member.record);
    } else {
        advance_in_parts(world, group, thin, h, time, bodies);
    }
    for (std::size_t i = 0; i < group.members.size(); ++i) {
        solids[i].take(thin[group.members[i]], bodies, first);
        ties[i].take(thin[group.members[i]]);
    }
    bodies.resize(first);
    for (TouchedBody& body : bodies) body.close_supports(h);
}

// Whether what bears the body was taken off its path and is in no solve yet. `is_late`: whether pushes for the whole
// step or those of each substep are meant.
bool is_unsettled(const TouchedBody& body, bool is_late) {
    const bool was_late = body.expected_late_force != Vec3{} || body.expected_late_torque != Vec3{};
    return body.is_off_path && was_late == is_late && !body.supports.empty() && !body.is_settled;
}

// Bodies that no group has pushed in a substep of h seconds but whose paths include pushes of the last step: borne by
// what still bears them without these.
void settle_released_bodies(const DeformableAccess& world, std::span<TouchedBody> bodies, double h, double time,
                            bool is_late) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        if (is_unsettled(bodies[b], is_late)) numbers.push_back(b);
    }
    if (numbers.empty()) return;
    const DeformableSettings& settings = world.settings.solver.deformable;
    const Substep substep{.h = h, .time = time, .gravity = world.settings.gravity, .settings = settings};
    const std::vector<BodyInertia> inertias = inertias_of(bodies, h);
    std::vector<BodyMove> moves(bodies.size());
    SupportSprings supports;
    supports.begin(numbers, bodies, 0, substep);
    supports.choose(moves, true, 0);
    world.deformables.pair_solver.set(settings.cloth);
    for (int solves = 1;; ++solves) {
        if (world.deformables.pair_solver.solve({}, {}, supports.springs(), inertias, {}, moves, world.workers) ==
            ClothSolver::not_finite)
            return;
        SupportSprings next = supports;
        if (!next.choose(moves, false, settings.thin_contact.change_tolerance) || solves == settings.cloth.max_solves)
            break;
        supports = std::move(next);
    }
    supports.finish(moves, h, bodies);
    for (TouchedBody& body : bodies) body.close_supports(h);
}

// Ties by index in `thin`; ties to what is gone or does not move hold nothing.
std::vector<ThinTie> find_ties(const DeformableAccess& world, std::span<const ThinDeformable> thin) {
    std::vector<ThinTie> ties;
    for (std::uint32_t i = 0; i < thin.size(); ++i) {
        DeformableRecord& record = *thin[i].record;
        record.tie_pulls.resize(record.definition.ties.size());
        for (std::size_t t = 0; t < record.definition.ties.size(); ++t) {
            const DeformableRecord* other = world.deformables.records.find(record.definition.ties[t].other);
            const auto found = std::ranges::find(thin, other, &ThinDeformable::record);
            if (found != thin.end()) ties.push_back({i, static_cast<std::uint32_t>(found - thin.begin()), t});
        }
    }
    return ties;
}

// What is tied to what is awake is awake.
bool wake_tied(const DeformableAccess& world) {
    bool has_woken_any = false;
    for (bool has_woken = true; has_woken; has_woken_any |= has_woken) {
        has_woken = false;
        for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
            if (!world.deformables.records.used(slot)) continue;
            DeformableRecord& own = world.deformables.records.at(slot);
            if (!own.definition.enabled) continue;
            for (const Tie& tie : own.definition.ties) {
                DeformableRecord* other = world.deformables.records.find(tie.other);
                if (other == nullptr || !other->definition.enabled || other->is_asleep == own.is_asleep) continue;
                own.is_asleep = other->is_asleep = false;
                own.quiet_time = other->quiet_time = 0;
                has_woken = true;
            }
        }
    }
    return has_woken_any;
}

// Contacts of a pair that has separated, or of what is gone, are forgotten; sleepers keep theirs.
void forget_parted(const DeformableAccess& world, std::span<const ThinGroup> groups,
                   std::span<const ThinDeformable> thin) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> together;
    for (const ThinGroup& group : groups) {
        for (const ThinPair& pair : group.pairs)
            together.emplace_back(thin[group.members[pair.a]].record->slot, thin[group.members[pair.b]].record->slot);
    }
    std::ranges::sort(together);
    const auto sleeps = [&](std::uint32_t slot) {
        return world.deformables.records.used(slot) && world.deformables.records.at(slot).is_asleep;
    };
    std::erase_if(world.deformables.thin_contacts, [&](const auto& memory) {
        return !std::ranges::binary_search(together, memory.first) &&
               !(sleeps(memory.first.first) && sleeps(memory.first.second));
    });
}

}  // namespace

bool wake_touched_thin(const DeformableAccess& world) {
    const double h = world.settings.time_step;
    const std::uint32_t count = world.deformables.records.slot_count();
    bool has_woken = wake_tied(world);
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        DeformableRecord& sleeper = world.deformables.records.at(slot);
        if (!is_thin(sleeper) || !sleeper.is_asleep) continue;
        const Bounds bounds = enlarged(sleeper.bounds(), reach_of(world, sleeper));
        for (std::uint32_t other = 0; other < count && sleeper.is_asleep; ++other) {
            if (!world.deformables.records.used(other)) continue;
            const DeformableRecord& awake = world.deformables.records.at(other);
            if (!is_thin(awake) || awake.is_asleep || !may_collide(awake.definition, sleeper.definition)) continue;
            const Bounds reach = enlarged(awake.bounds(), reach_of(world, awake));
            if (!overlaps(bounds, reach) || !may_touch_others(reach)) continue;
            std::vector<std::array<std::uint32_t, 2>> segments_a, segments_b;
            const ThinSurface a = surface_of(awake, segments_a), b = surface_of(sleeper, segments_b);
            const double pull = std::max(pull_on(world, awake), pull_on(world, sleeper));
            ThinPair pair;
            find_candidates(world, awake, sleeper, pair);
            if (!will_touch(a, b, pair.candidates, h, pull)) continue;
            sleeper.is_asleep = false;
            sleeper.quiet_time = 0;
            has_woken = true;
        }
    }
    return has_woken;
}

std::vector<ThinGroup> find_thin_groups(const DeformableAccess& world, std::span<const ThinDeformable> thin,
                                        std::span<const TouchedBody> bodies) {
    EMBODY_ZONE("find sheets and ropes that touch");
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
            ThinPair pair{.a = a,
                          .b = b,
                          .friction = friction_between(one.definition.material, two.definition.material,
                                                       world.rigid.surface_pairs)};
            find_candidates(world, one, two, pair);
            if (pair.candidates.empty()) continue;
            pairs.push_back(std::move(pair));
            const std::uint32_t i = root_of(group, a), k = root_of(group, b);
            group[std::max(i, k)] = std::min(i, k);
        }
    }
    // A sheet with itself, whose candidates each part of a step finds.
    for (std::uint32_t i = 0; i < thin.size(); ++i) {
        const DeformableRecord& record = *thin[i].record;
        if (!record.cloth()) continue;
        const Material& material = record.definition.material;
        ThinPair own{
            .a = i, .b = i, .friction = friction_between(material, material, world.rigid.surface_pairs), .held = {}};
        own.held.are_of_one = true;
        for (const Tie& tie : record.definition.ties) {
            own.held.of_a.resize(record.nodes().size(), false);
            own.held.of_a[tie.node] = true;
        }
        pairs.push_back(std::move(own));
    }
    std::vector<ThinTie> ties = find_ties(world, thin);
    for (const ThinTie& tie : ties) {
        const std::uint32_t i = root_of(group, tie.member), k = root_of(group, tie.other);
        group[std::max(i, k)] = std::min(i, k);
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
        own.in_substeps |= thin[i].record->rope() != nullptr || has_solid_ties(world, *thin[i].record);
    }
    for (ThinPair& pair : pairs) {
        ThinGroup& own = groups[number[pair.a]];
        pair.a = place[pair.a];
        pair.b = place[pair.b];
        own.pairs.push_back(std::move(pair));
    }
    for (ThinGroup& own : groups) {
        const ThinDeformable& first = thin[own.members[0]];
        if (own.members.size() == 1 && first.record->rope() && !may_touch_moving_body(first, bodies))
            add_own_pair(world, *first.record, own);
    }
    for (const ThinTie& tie : ties)
        groups[number[tie.member]].ties.push_back({place[tie.member], place[tie.other], tie.index});
    forget_parted(world, groups, thin);
    return groups;
}

void advance_thin_groups(const DeformableAccess& world, std::span<const ThinGroup> groups,
                         std::span<ThinDeformable> thin, std::vector<TouchedBody>& bodies, int k, int substeps) {
    EMBODY_ZONE("advance sheets and ropes");
    const double step = world.settings.time_step, h = step / substeps;
    ThinOnSolids::Surfaces surfaces;
    for (const ThinGroup& group : groups) {
        if (group.in_substeps) advance_group(world, group, thin, h, (k - 1) * h, bodies, surfaces);
    }
    settle_released_bodies(world, bodies, h, (k - 1) * h, false);
    if (k < substeps) return;
    for (TouchedBody& body : bodies) {
        body.enter_whole_step(substeps);
        body.late_impulse = body.impulse;
        body.late_angular_impulse = body.angular_impulse;
    }
    for (const ThinGroup& group : groups) {
        if (!group.in_substeps) advance_group(world, group, thin, step, 0, bodies, surfaces);
    }
    settle_released_bodies(world, bodies, step, 0, true);
    for (TouchedBody& body : bodies) {
        body.late_impulse = body.impulse - body.late_impulse;
        body.late_angular_impulse = body.angular_impulse - body.late_angular_impulse;
    }
}

void forget_thin_contacts(DeformableState& deformables, std::uint32_t slot) {
    std::erase_if(deformables.thin_contacts,
                  [&](const auto& memory) { return memory.first.first == slot || memory.first.second == slot; });
}

}  // namespace embody::physics::stages
