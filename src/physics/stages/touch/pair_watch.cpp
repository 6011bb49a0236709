// SPDX-License-Identifier: MIT
#include "physics/stages/touch/pair_watch.h"

#include <algorithm>

#include "foundation/zone.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// m: travel that counts for a body that is put into a slot; no pair is skipped for more than this.
constexpr double max_displacement = 1;

// Displacement of dynamic bodies relative to immovable ones in the step by free fall, m; it is in no body's own bound.
double common_fall(const TouchAccess& world) {
    const double dt = world.settings.time_step;
    return length(world.settings.gravity) * dt * dt / 2;
}

std::uint32_t take_record(TouchMemory& memory) {
    if (memory.free_records.empty()) {
        memory.records.push_back({});
        return static_cast<std::uint32_t>(memory.records.size() - 1);
    }
    const std::uint32_t record = memory.free_records.back();
    memory.free_records.pop_back();
    memory.records[record] = {};
    return record;
}

// In place, both being sorted: removed pairs are taken out from the front on, new ones inserted from the back on.
void follow_broad_phase(const TouchAccess& world) {
    TouchMemory& memory = world.contacts.touch;
    if (memory.watches_version == world.contacts.broad_phase.pairs_version()) return;
    memory.watches_version = world.contacts.broad_phase.pairs_version();
    const std::vector<BroadPhase::Pair>& pairs = *world.contacts.pairs;
    std::vector<PairWatch>& watches = memory.watches;
    std::size_t kept = 0, next = 0;
    for (const PairWatch& watch : watches) {
        while (next < pairs.size() && pairs[next] < watch.pair) ++next;
        if (next < pairs.size() && pairs[next] == watch.pair) {
            watches[kept++] = watch;
        } else {
            memory.free_records.push_back(watch.record);
            memory.is_laid_out = memory.is_laid_out && watch.count == 0;
        }
    }
    watches.resize(pairs.size());
    for (std::size_t place = pairs.size(); place-- > 0;) {
        const bool is_known = kept > 0 && watches[kept - 1].pair == pairs[place];
        watches[place] = is_known ? watches[--kept] : PairWatch{.pair = pairs[place], .record = take_record(memory)};
    }
}

// Pairs and contacts are sorted alike: one pass over the two counts the contacts of each pair.
void count_contacts(const TouchAccess& world) {
    if (world.contacts.touch.is_laid_out) return;
    world.contacts.touch.is_laid_out = true;
    for (PairWatch& watch : world.contacts.touch.watches) watch.count = 0;
    std::vector<Contact>& contacts = world.contacts.list;
    std::size_t next = 0, kept = 0;
    const auto pair_of_next = [&] { return BroadPhase::Pair{contacts[next].a, contacts[next].b}; };
    for_each_live_pair(world, [&](PairWatch& watch, std::uint32_t) {
        while (next < contacts.size() && pair_of_next() < watch.pair) ++next;
        for (; next < contacts.size() && pair_of_next() == watch.pair; ++next, ++kept, ++watch.count) {
            if (kept != next) contacts[kept] = contacts[next];
        }
        if (watch.count > 0) watch.next_check_travel = 0;
    });
    contacts.resize(kept);
}

}  // namespace

void update_watches(const TouchAccess& world) {
    EMBODY_ZONE("watch pairs");
    follow_broad_phase(world);
    list_live_pairs(world);
    count_contacts(world);
}

void list_live_pairs(const TouchAccess& world) {
    TouchMemory& memory = world.contacts.touch;
    if (world.activity.sleepers.empty()) {
        memory.live_version = 0;
        return;
    }
    const std::uint64_t pairs_version = world.contacts.broad_phase.pairs_version();
    if (memory.live_version == pairs_version && memory.awake_version == world.activity.awake_version) return;
    memory.live_version = pairs_version;
    memory.awake_version = world.activity.awake_version;
    memory.is_laid_out = false;
    memory.live.clear();
    const auto is_awake = [&](std::uint32_t body) {
        return !world.activity.is_asleep(body) && world.rigid.record(body).definition.kind != BodyKind::static_body;
    };
    for (std::uint32_t i = 0; i < memory.watches.size(); ++i) {
        const auto [a, b] = memory.watches[i].pair;
        if (is_awake(a) || is_awake(b)) memory.live.push_back(i);
    }
}

void introduce_body(const RigidState& rigid, std::uint32_t body, TouchMemory& memory) {
    memory.bodies.resize(rigid.bodies.slot_count());
    memory.path_bounds.resize(rigid.bodies.slot_count());
    const BodyRecord& record = rigid.record(body);
    const double path = memory.bodies[body].path + max_displacement;
    memory.path_bounds[body] = path;
    const bool is_surface = record.reach == 0 && record.definition.kind == BodyKind::static_body;
    memory.bodies[body] = {.size = is_surface ? 1e300 : record.reach,
                           .path = path,
                           .version = record.version,
                           .group = record.definition.collision_group,
                           .mask = record.definition.collision_mask,
                           .is_round = record.is_round,
                           .is_ball = record.is_ball,
                           .yields = rigid.motion[body].inverse_mass > 0,
                           .stands = record.definition.kind == BodyKind::static_body};
}

// No surface point goes farther than the centre of mass and the chord of the body's turn at its reach. A ball that
// turns stays where it is.
void start_motion(const TouchAccess& world) {
    const double dt = world.settings.time_step;
    for (const std::uint32_t body : world.activity.awake) {
        BodyState& state = world.rigid.motion[body];
        TouchBody& touch = world.contacts.touch.bodies[body];
        const double reach = touch.is_ball ? 0 : touch.size;
        const Quat turn = state.rotation * conjugate(state.start_rotation);
        touch.path += distance(state.center, state.start_center) + 2 * length(Vec3{turn.x, turn.y, turn.z}) * reach;
        touch.turning = length(state.angular_velocity) * reach;
        state.start_center = state.center;
        state.start_rotation = state.rotation;
        state.turn = {};

        double speed = length(state.linear_velocity) + touch.turning;
        if (touch.yields) {
            touch.acceleration = world.rigid.constants[body].acceleration;
            speed += length(touch.acceleration - world.settings.gravity) * dt / 2;
        }
        world.contacts.touch.path_bounds[body] = touch.path + speed * dt;
    }
}

void list_near_pairs(const TouchAccess& world) {
    TouchMemory& memory = world.contacts.touch;
    memory.pairs.clear();
    const double fall = common_fall(world);
    std::uint32_t first = 0;
    for_each_live_pair(world, [&](const PairWatch& watch, std::uint32_t place) {
        if (memory.path_bounds[watch.pair.a] + memory.path_bounds[watch.pair.b] + fall < watch.next_check_travel)
            return;
        memory.pairs.push_back({.watch = place, .first = first, .count = watch.count});
        first += watch.count;
    });
}

void leave_alone(const TouchAccess& world, PairWatch& watch, double travel) {
    const std::vector<TouchBody>& bodies = world.contacts.touch.bodies;
    watch.next_check_travel =
        bodies[watch.pair.a].path + bodies[watch.pair.b].path + std::min(travel, max_displacement);
}

}  // namespace embody::physics::stages
