// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/rigid/wake.h"
#include "physics/stages/stages.h"
#include "physics/stages/touch/pair_watch.h"
#include "physics/stages/touch/reachable_points.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// Travel up to which contacts are known to hold all corners within their margin, m.
static_assert(CollisionSettings{}.follow_travel == Manifold::whole_travel);

const CollisionSettings& collision_settings(const TouchAccess& world) { return world.settings.solver.collision; }

bool may_collide(const TouchAccess& world, std::uint32_t a, std::uint32_t b) {
    const TouchBody &ta = world.contacts.touch.bodies[a], &tb = world.contacts.touch.bodies[b];
    if (!(ta.group & tb.mask) || !(tb.group & ta.mask)) return false;
    return world.joints.jointed_pairs.empty() || !world.joints.jointed_pairs.contains({a, b});
}

// Whether the body moves by itself: an awake dynamic body, or a kinematic one with a velocity.
bool is_moving(const TouchAccess& world, std::uint32_t body) {
    const BodyKind kind = world.rigid.record(body).definition.kind;
    if (kind == BodyKind::dynamic_body) return !world.activity.is_asleep(body);
    return kind == BodyKind::kinematic_body &&
           (world.rigid.motion[body].linear_velocity != Vec3{} || world.rigid.motion[body].angular_velocity != Vec3{});
}

// A ball has one point of contact, which does not jump to another corner: a fraction of its size is far enough. Grains
// of millimetres would have most of their contacts with others that they do not touch.
double within_ball(const TouchAccess& world, double distance, const TouchBody& a, const TouchBody& b) {
    const double fraction = collision_settings(world).ball_margin_fraction;
    if (a.is_ball) distance = std::min(distance, fraction * a.size);
    if (b.is_ball) distance = std::min(distance, fraction * b.size);
    return distance;
}

// Gap up to which surfaces are looked for whatever their speed, m.
double base_margin_of(const TouchAccess& world, const BroadPhase::Pair& pair) {
    return within_ball(world, collision_settings(world).contact_margin, world.contacts.touch.bodies[pair.a],
                       world.contacts.touch.bodies[pair.b]);
}

// Maximum approach of the surfaces within the step: the margin of the narrow phase.
double margin_of(const TouchAccess& world, std::uint32_t a, std::uint32_t b) {
    const double dt = world.settings.time_step;
    const TouchBody &ta = world.contacts.touch.bodies[a], &tb = world.contacts.touch.bodies[b];
    const Vec3 velocity = world.rigid.motion[b].linear_velocity - world.rigid.motion[a].linear_velocity;
    const double travel =
        (length(velocity) + (ta.turning + tb.turning)) * dt + length(tb.acceleration - ta.acceleration) * dt * dt / 2;

    // At gaps larger than the movable body a contact normal is unreliable; the continuous stage takes over there.
    double size = 1e300;
    if (ta.yields) size = std::min(size, ta.size);
    if (tb.yields) size = std::min(size, tb.size);
    return within_ball(world, collision_settings(world).contact_margin, ta, tb) + std::min(travel, 2 * size);
}

void collide_pair(const TouchAccess& world, std::uint32_t a, std::uint32_t b, std::vector<Manifold>& manifolds) {
    manifolds.clear();
    collide(*world.rigid.record(a).shape, world.rigid.pose(a), *world.rigid.record(b).shape, world.rigid.pose(b),
            margin_of(world, a, b), manifolds);
}

// Whether some point of the contact is or comes within wake_gap in this step.
bool meets_in_step(const TouchAccess& world, const Contact& contact) {
    const double wake_gap = collision_settings(world).wake_gap;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double approach = -dot(relative_velocity(contact, point, world.rigid.motion), contact.normal);
        if (point.separation - std::max(0.0, approach) * world.settings.time_step < wake_gap) return true;
    }
    return false;
}

// Wakes the sleeping one of two bodies, with its group, if the other one is about to touch it.
bool wake_if_touched(const TouchAccess& world, const BroadPhase::Pair& pair, std::vector<Manifold>& manifolds) {
    const bool a_sleeps = world.activity.is_asleep(pair.a), b_sleeps = world.activity.is_asleep(pair.b);
    if (a_sleeps == b_sleeps || !is_moving(world, a_sleeps ? pair.b : pair.a)) return false;
    if (!may_collide(world, pair.a, pair.b)) return false;
    collide_pair(world, pair.a, pair.b, manifolds);
    for (const Manifold& manifold : manifolds) {
        if (!meets_in_step(world, make_contact(pair.a, pair.b, manifold, world.rigid.motion))) continue;
        wake_group_of(world, a_sleeps ? pair.a : pair.b);
        return true;
    }
    return false;
}

// Wakes every sleeping group that an awake body is about to touch.
void wake_touched(const TouchAccess& world, std::vector<Manifold>& manifolds) {
    if (world.activity.sleepers.empty()) return;
    const std::vector<BroadPhase::Pair>& pairs = *world.contacts.pairs;
    for (const std::uint32_t live : world.contacts.touch.live) {
        if (!wake_if_touched(world, pairs[live], manifolds)) continue;

        // Woken bodies may wake more: any later pair counts now.
        for (std::size_t i = live + 1; i < pairs.size(); ++i) wake_if_touched(world, pairs[i], manifolds);
        gather_awake(world);
        update_watches(world);
        start_motion(world);
        return;
    }
}

/// A pair in the frame of its larger body: turning that one moves surface points the least. A ball's own turn does not
/// count: its contacts are in the frame of the other body, those of two balls in the world's axes.
struct RelativePose {
    Vec3 center;
    Quat rotation;
    SeenFrom seen;
    bool has_ball = false;
};

RelativePose relative_pose(const TouchAccess& world, const BroadPhase::Pair& pair) {
    const TouchBody &a = world.contacts.touch.bodies[pair.a], &b = world.contacts.touch.bodies[pair.b];
    const bool from_b = a.is_ball != b.is_ball ? a.is_ball : b.size > a.size;
    const BodyState& larger = world.rigid.motion[from_b ? pair.b : pair.a];
    const BodyState& smaller = world.rigid.motion[from_b ? pair.a : pair.b];
    if (a.is_ball && b.is_ball) return {smaller.center - larger.center, {}, {{}, from_b}, true};
    const Vec3 center = rotate_inverse(larger.rotation, smaller.center - larger.center);
    const bool has_ball = a.is_ball || b.is_ball;
    const Quat rotation = has_ball ? Quat{} : conjugate(larger.rotation) * smaller.rotation;
    return {center, rotation, {larger.rotation, from_b}, has_ball};
}

// Maximum displacement of a surface point of the smaller body relative to the larger one since they were compared.
double moved_since(const TouchAccess& world, const BroadPhase::Pair& pair, const PairRecord& record,
                   const RelativePose& now) {
    if (now.has_ball) return distance(now.center, record.relative_center);
    const double reach = std::min(world.contacts.touch.bodies[pair.a].size, world.contacts.touch.bodies[pair.b].size);
    const Quat turn = now.rotation * conjugate(record.relative_rotation);
    const double sine = length(Vec3{turn.x, turn.y, turn.z});
    return distance(now.center, record.relative_center) + 2 * sine * reach;
}

// Lists of contacts are most of a world's memory. They grow by half: with smaller steps the freed blocks add up to
// more.
template <class Item>
void resize_list(std::vector<Item>& list, std::size_t size) {
    if (size > list.capacity()) list.reserve(size + size / 2);
    list.resize(size);
}

// How far a pair may move while its contacts follow it, m.
double follow_travel_of(const CollisionSettings& settings, const TouchBody& a, const TouchBody& b, bool is_whole) {
    // A ball over a face is followed exactly; elsewhere its normal turns with every step.
    const bool is_exact = is_whole && (a.is_ball || b.is_ball);
    if ((a.is_round || b.is_round) && !is_exact) return settings.follow_travel_round;
    return is_whole ? settings.follow_travel : settings.follow_travel_partial;
}

/// The contacts of one pair in the last step.
using OldContacts = std::span<const Contact>;

/// A pair as it is in this step.
struct PairNow {
    BroadPhase::Pair pair;
    RelativePose pose;
    double margin = 0;  ///< maximum gap that can close within the step, m
    double moved = 0;   ///< since the pair was compared, m
    OldContacts old;
};

// Whether the last comparison is still valid: same bodies, hardly moved, and searched as far as now needed.
bool may_follow(const TouchAccess& world, const PairRecord& record, const PairNow& now) {
    const TouchBody &a = world.contacts.touch.bodies[now.pair.a], &b = world.contacts.touch.bodies[now.pair.b];
    if (record.version_a != a.version || record.version_b != b.version) return false;
    if (record.contact_count != now.old.size()) return false;
    if (now.margin + now.moved > record.margin) return false;
    return now.old.empty() || now.moved <= follow_travel_of(collision_settings(world), a, b, record.is_whole);
}

// A contact with a mesh is named by a triangle, and another one comes under a sliding body all the time: a contact with
// a new name takes over an old contact of nearly the same normal that no other one takes over.
void match_by_normal(OldContacts old, std::span<Contact> contacts, bool a_is_surface, const SolverSettings& settings) {
    const auto piece_of = [&](const Contact& c) { return a_is_surface ? c.piece_b : c.piece_a; };
    const auto is_named = [](const Contact& c, std::span<const Contact> others) {
        return std::any_of(others.begin(), others.end(),
                           [&](const Contact& o) { return contact_key(o) == contact_key(c); });
    };
    std::uint64_t taken = 0;
    const std::size_t count = std::min<std::size_t>(old.size(), 64);
    for (std::size_t i = 0; i < count; ++i) taken |= std::uint64_t{is_named(old[i], contacts)} << i;
    for (Contact& contact : contacts) {
        if (is_named(contact, old)) continue;
        double best = settings.collision.same_normal_cosine;
        std::size_t chosen = count;
        for (std::size_t i = 0; i < count; ++i) {
            if ((taken >> i & 1u) != 0 || piece_of(old[i]) != piece_of(contact)) continue;
            const double cosine = dot(old[i].normal, contact.normal);
            if (cosine <= best) continue;
            best = cosine;
            chosen = i;
        }
        if (chosen == count) continue;
        taken |= std::uint64_t{1} << chosen;
        match_points(old[chosen], contact, settings.constraint.contact);
    }
}

// Takes the coefficients that the pair's contacts had in the last step.
void take_material(const Contact& old, Contact& contact) {
    contact.friction_static = old.friction_static;
    contact.friction_dynamic = old.friction_dynamic;
    contact.friction_torsional = old.friction_torsional;
    contact.friction_rolling = old.friction_rolling;
    contact.bounces = old.bounces;
}

// Finds the contacts of a pair anew and hands them the impulses of the old ones.
void compare_pair(const TouchAccess& world, PairRecord& record, const PairNow& now, TouchMemory::Worker& worker) {
    const BroadPhase::Pair pair = now.pair;
    const OldContacts old = now.old;
    const BodyRecord &a = world.rigid.record(pair.a), &b = world.rigid.record(pair.b);
    const bool is_known = record.version_a == a.version && record.version_b == b.version;
    if (!is_known) record.memory = {};
    worker.manifolds.clear();
    const TouchMemory& memory = world.contacts.touch;
    const double searched = now.margin + within_ball(world, collision_settings(world).follow_travel,
                                                     memory.bodies[pair.a], memory.bodies[pair.b]);
    collide(*a.shape, world.rigid.pose(pair.a), *b.shape, world.rigid.pose(pair.b), searched, record.memory,
            worker.manifolds);
    record.version_a = a.version;
    record.version_b = b.version;
    record.contact_count = static_cast<std::uint32_t>(worker.manifolds.size());
    record.margin = searched;
    record.is_whole = std::all_of(worker.manifolds.begin(), worker.manifolds.end(),
                                  [](const Manifold& manifold) { return manifold.is_whole; });
    record.relative_center = now.pose.center;
    record.relative_rotation = now.pose.rotation;
    if (worker.manifolds.empty()) {
        const bool is_apart = record.memory.kind == PairMemory::Kind::apart;
        if (is_apart) record.margin = std::max(searched, record.memory.gap);
        return;
    }
    if (a.is_round || b.is_round) {
        record.margin = std::min(searched, leave_out_unreachable(world, pair, worker.manifolds));
    }

    const auto first = static_cast<std::ptrdiff_t>(worker.found.size());
    const auto has_material = [&](const Contact& contact) {
        return is_known && !old.empty() && old.front().is_on_edge == contact.is_on_edge;
    };
    const std::size_t wanted = worker.found.size() + worker.manifolds.size();
    if (wanted > worker.found.capacity()) worker.found.reserve(wanted + wanted / 2);
    for (const Manifold& manifold : worker.manifolds) {
        worker.found.push_back(make_contact(pair.a, pair.b, manifold, world.rigid.motion, now.pose.seen));
        Contact& contact = worker.found.back();
        if (has_material(contact)) {
            take_material(old.front(), contact);
        } else {
            set_material(contact, combine(a.definition.material, b.definition.material, world.rigid.surface_pairs));
        }
        // Impulses that turn with the axes do work: what bounces keeps its plane. Test: RandomAccounts.
        contact.are_balls = !contact.bounces && memory.bodies[pair.a].is_ball && memory.bodies[pair.b].is_ball;
    }

    // Both are sorted by key.
    std::sort(worker.found.begin() + first, worker.found.end(),
              [](const Contact& c, const Contact& d) { return contact_key(c) < contact_key(d); });
    auto old_contact = old.begin();
    for (auto contact = worker.found.begin() + first; contact != worker.found.end(); ++contact) {
        while (old_contact != old.end() && contact_key(*old_contact) < contact_key(*contact)) ++old_contact;
        if (old_contact != old.end() && contact_key(*old_contact) == contact_key(*contact)) {
            match_points(*old_contact, *contact, world.settings.solver.constraint.contact);
        }
    }
    const bool a_is_surface = a.reach == 0;
    if (!old.empty() && (a_is_surface || b.reach == 0)) {
        match_by_normal(old, std::span(worker.found).subspan(static_cast<std::size_t>(first)), a_is_surface,
                        world.settings.solver);
    }
}

FollowedPair followed_pair(const TouchAccess& world, const PairRecord& record, const PairNow& pair) {
    const BodyState &a = world.rigid.motion[pair.pair.a], &b = world.rigid.motion[pair.pair.b];
    const RelativePose& now = pair.pose;
    const Quat turn = now.rotation * conjugate(record.relative_rotation);
    const double sign = turn.w < 0 ? -1 : 1;
    const Mat3 axes = to_matrix(now.seen.axes);
    return {.shift = to_vec3f(now.center - record.relative_center),
            .turn = to_vec3f(sign * Vec3{turn.x, turn.y, turn.z}),
            .turn_w = static_cast<float>(sign * turn.w),
            .axes = {to_vec3f(axes.x), to_vec3f(axes.y), to_vec3f(axes.z)},
            .apart = to_vec3f(b.center - a.center),
            .velocity = to_vec3f(b.linear_velocity - a.linear_velocity),
            .spin_a = to_vec3f(a.angular_velocity),
            .spin_b = to_vec3f(b.angular_velocity),
            .has_ball = now.has_ball};
}

// A bouncing contact whose load changes no velocity by more than rounding carries no load: bodies that only touch, as
// the balls of a rack do, are as free as separated ones.
void clear_rounding_load(const TouchAccess& world, Contact& contact) {
    constexpr double slightest_load = 1e-6;  // m/s; rounding leaves 1e-9, a step of gravity gives 0.16
    if (!contact.was_loaded || !contact.bounces) return;
    const double inverse_masses =
        world.rigid.motion[contact.a].inverse_mass + world.rigid.motion[contact.b].inverse_mass;
    contact.was_loaded = load_of(contact) * inverse_masses > slightest_load;
}

void write_summary(const TouchAccess& world, std::uint32_t index) {
    Contact& contact = world.contacts.list[index];
    clear_rounding_load(world, contact);
    world.contacts.summaries[index] = summary_of(contact, world.settings.solver.constraint.contact.deep_penetration);
}

// Puts a pair's newly found contacts in the place of as many old ones.
void replace_contacts(const TouchAccess& world, PairTouch& touch, TouchMemory::Worker& worker) {
    for (std::uint32_t k = 0; k < touch.count; ++k) {
        world.contacts.list[touch.first + k] = worker.found[touch.found_first + k];
        write_summary(world, touch.first + k);
    }
    worker.found.resize(touch.found_first);
    touch.finder = PairTouch::keeps;
}

void follow_contacts(const TouchAccess& world, const PairTouch& touch, const FollowedPair& followed) {
    for (std::uint32_t i = touch.first; i < touch.first + touch.count; ++i) {
        follow_bodies(world.contacts.list[i], followed);
        write_summary(world, i);
    }
}

// Whether the pair's contacts are where they were in the last step, since its bodies have not moved.
bool may_keep(const TouchAccess& world, const PairWatch& watch, const PairRecord& record) {
    const TouchBody &a = world.contacts.touch.bodies[watch.pair.a], &b = world.contacts.touch.bodies[watch.pair.b];
    return a.stands && b.stands && watch.count > 0 && record.contact_count == watch.count &&
           record.version_a == a.version && record.version_b == b.version;
}

void keep_contacts(const TouchAccess& world, const PairTouch& touch) {
    for (std::uint32_t i = touch.first; i < touch.first + touch.count; ++i) {
        begin_step(world.contacts.list[i]);
        write_summary(world, i);
        world.contacts.summaries[i].is_kept = true;
    }
}

// One of the two must be movable, and neither may sleep.
bool may_touch(const TouchAccess& world, const BroadPhase::Pair& pair) {
    const std::vector<TouchBody>& bodies = world.contacts.touch.bodies;
    if (!bodies[pair.a].yields && !bodies[pair.b].yields) return false;
    const bool may_sleep = !world.activity.sleepers.empty();
    if (may_sleep && (world.activity.is_asleep(pair.a) || world.activity.is_asleep(pair.b))) return false;
    return may_collide(world, pair.a, pair.b);
}

// Decides which contacts a pair has in this step: the old ones follow its bodies, or they are found anew.
void touch_pair(const TouchAccess& world, PairTouch& touch, std::uint8_t finder, TouchMemory::Worker& worker) {
    PairWatch& watch = world.contacts.touch.watches[touch.watch];
    if (!may_touch(world, watch.pair)) return;
    PairRecord& record = world.contacts.touch.records[watch.record];
    if (may_keep(world, watch, record)) {
        touch.next_count = touch.count;
        return keep_contacts(world, touch);
    }
    PairNow now{.pair = watch.pair,
                .pose = relative_pose(world, watch.pair),
                .margin = margin_of(world, watch.pair.a, watch.pair.b),
                .old = OldContacts(world.contacts.list).subspan(touch.first, touch.count)};
    now.moved = moved_since(world, watch.pair, record, now.pose);
    if (may_follow(world, record, now)) {
        touch.next_count = touch.count;
        if (touch.count > 0) return follow_contacts(world, touch, followed_pair(world, record, now));
        return leave_alone(world, watch, record.margin - now.moved - base_margin_of(world, watch.pair));
    }

    touch.finder = finder;
    touch.found_first = static_cast<std::uint32_t>(worker.found.size());
    compare_pair(world, record, now, worker);
    touch.next_count = static_cast<std::uint32_t>(worker.found.size()) - touch.found_first;
    if (touch.next_count == touch.count) replace_contacts(world, touch, worker);
    watch.next_check_travel = 0;
    if (touch.next_count == 0) leave_alone(world, watch, record.margin - base_margin_of(world, watch.pair));
}

// Moves the contacts that a pair keeps to their next place.
void move_kept(const TouchAccess& world, const PairTouch& touch) {
    const auto move = [&](auto& list) {
        const auto from = list.begin() + touch.first, to = list.begin() + touch.next_first;
        touch.next_first < touch.first ? std::copy(from, from + touch.count, to)
                                       : std::copy_backward(from, from + touch.count, to + touch.count);
    };
    move(world.contacts.list);
    move(world.contacts.summaries);
}

// Gives each pair's contacts their place in the order of the pairs, which does not depend on the worker that found
// them. All move within one list: those that move down in ascending order, then those that move up in descending order,
// so that none overwrites one that has yet to move.
void lay_out(const TouchAccess& world) {
    EMBODY_ZONE("lay out contacts");
    std::vector<PairTouch>& pairs = world.contacts.touch.pairs;
    std::uint32_t total = 0;
    bool is_same = true;
    for (PairTouch& touch : pairs) {
        touch.next_first = total;
        total += touch.next_count;
        is_same = is_same && touch.next_count == touch.count;
    }
    if (is_same) return;
    resize_list(world.contacts.list, std::max<std::size_t>(world.contacts.list.size(), total));
    world.contacts.summaries.resize(world.contacts.list.size());
    const auto keeps = [](const PairTouch& t) { return t.finder == PairTouch::keeps && t.next_count > 0; };
    for (auto t = pairs.begin(); t != pairs.end(); ++t) {
        if (keeps(*t) && t->next_first < t->first) move_kept(world, *t);
    }
    for (auto t = pairs.rbegin(); t != pairs.rend(); ++t) {
        if (keeps(*t) && t->next_first > t->first) move_kept(world, *t);
    }

    // New contacts fill the places between.
    for (const PairTouch& touch : pairs) {
        if (touch.next_count == touch.count) continue;
        world.contacts.touch.watches[touch.watch].count = touch.next_count;
        for (std::uint32_t k = 0; k < touch.next_count; ++k) {
            const Contact& contact = world.contacts.touch.workers[touch.finder].found[touch.found_first + k];
            world.contacts.list[touch.next_first + k] = contact;
            write_summary(world, touch.next_first + k);
        }
    }
    world.contacts.list.resize(total);
    world.contacts.summaries.resize(total);
}

// Calls work(worker, range) for ranges of the pairs to look at, on all workers where there are enough of them. Some
// pairs take a hundred times as long as others, so each worker takes the next few when it is done: first of its own
// part, whose contacts it had in the last step, then of the others'.
template <class Work>
void parallel_for_pairs(const TouchAccess& world, Work work) {
    EMBODY_ZONE("compare near pairs");
    constexpr std::size_t min_parallel_count = 200, pairs_in_range = 32;  // pairs; waking the workers costs as many
    const std::size_t count = world.contacts.touch.pairs.size();
    const int workers = world.workers.workers();
    if (count < min_parallel_count || workers == 1) return work(0, IndexRange{0, count});
    struct alignas(64) Part {
        std::atomic<std::size_t> next{0};
    };
    std::vector<Part> parts(static_cast<std::size_t>(workers));
    world.workers.run([&](int worker) {
        for (int turn = 0; turn < workers; ++turn) {
            const int owner = (worker + turn) % workers;
            const IndexRange part = range_of(count, owner, workers);
            std::atomic<std::size_t>& next = parts[static_cast<std::size_t>(owner)].next;
            while (true) {
                const std::size_t first = part.first + next.fetch_add(pairs_in_range, std::memory_order_relaxed);
                if (first >= part.last) break;
                work(worker, IndexRange{first, std::min(first + pairs_in_range, part.last)});
            }
        }
    });
}

// Records are scattered in memory: they are prefetched while earlier pairs are processed.
constexpr std::size_t fetched_ahead = 4;
void fetch(const TouchMemory& memory, const PairTouch& touch) {
    const PairRecord& record = memory.records[memory.watches[touch.watch].record];
    __builtin_prefetch(&record.version_a);
    __builtin_prefetch(&record.memory);
}

}  // namespace

void find_contacts(const TouchAccess& world) {
    TouchMemory& memory = world.contacts.touch;
    memory.workers.resize(static_cast<std::size_t>(world.workers.workers()));
    update_watches(world);
    start_motion(world);
    wake_touched(world, memory.workers[0].manifolds);

    // Finds the contacts of each pair that is due.
    list_near_pairs(world);
    world.contacts.summaries.resize(world.contacts.list.size());
    for (TouchMemory::Worker& worker : memory.workers) worker.found.clear();
    parallel_for_pairs(world, [&](int worker, IndexRange range) {
        TouchMemory::Worker& own = memory.workers[static_cast<std::size_t>(worker)];
        for (std::size_t i = range.first; i < range.last; ++i) {
            if (i + fetched_ahead < range.last) fetch(memory, memory.pairs[i + fetched_ahead]);
            touch_pair(world, memory.pairs[i], static_cast<std::uint8_t>(worker), own);
        }
    });
    lay_out(world);
}

}  // namespace embody::physics::stages
