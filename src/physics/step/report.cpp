// SPDX-License-Identifier: MIT
#include "physics/step/report.h"

#include <algorithm>
#include <array>

#include "physics/definitions/step_report.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/state/contact_state.h"
#include "physics/state/event_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::step {

namespace {

std::uint64_t user_data_of(const RigidState& rigid, BodyHandle body) {
    const BodyRecord* record = rigid.bodies.find(body);
    return record ? record->definition.user_data : 0;
}

// Place, normal and speed at which a pair began to touch: of its first touching region and its fastest one.
ContactEvent begin_event(const ReportAccess& world, const TouchingPair& pair) {
    const std::array<std::uint32_t, 5> key{pair.a.index, pair.b.index, 0, 0, 0};
    auto contact = std::lower_bound(world.contacts.list.begin(), world.contacts.list.end(), key,
                                    [](const Contact& c, const auto& k) { return contact_key(c) < k; });
    const Contact* first = nullptr;
    double approach = 0;
    for (; contact != world.contacts.list.end() && contact->a == pair.a.index && contact->b == pair.b.index;
         ++contact) {
        if (!is_touching(*contact)) continue;
        if (!first) first = &*contact;
        approach = std::max<double>(approach, contact->approach_speed);
    }
    return {ContactEvent::Kind::begin,
            pair.a,
            pair.b,
            user_data_of(world.rigid, pair.a),
            user_data_of(world.rigid, pair.b),
            position_of(*first, first->points[0], world.rigid.motion),
            first->normal,
            approach};
}

// The pairs that touch now, sorted; contacts are sorted by body slot and so nearly always give them in order.
void list_touching(const ReportAccess& world, std::vector<TouchingPair>& pairs) {
    pairs.clear();
    for (const ContactSummary& contact : world.contacts.summaries) {
        if (!contact.touches) continue;
        const TouchingPair pair{world.rigid.bodies.handle_at(contact.a), world.rigid.bodies.handle_at(contact.b)};
        if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
    }
    if (!std::is_sorted(pairs.begin(), pairs.end())) std::sort(pairs.begin(), pairs.end());
}

void end_touching(const ReportAccess& world, const TouchingPair& pair) {
    // Pairs that fell asleep still touch, without an event.
    const auto sleeps = [&](BodyHandle body) {
        return world.rigid.bodies.contains(body) && world.activity.is_asleep(body.index);
    };
    if (sleeps(pair.a) || sleeps(pair.b)) return;
    world.events.contacts.push_back({ContactEvent::Kind::end, pair.a, pair.b, user_data_of(world.rigid, pair.a),
                                     user_data_of(world.rigid, pair.b), Vec3{}, Vec3{}, 0});
}

// Walks through the pairs that touched in the last step and those that touch now, both sorted: ends first.
void write_contact_events(const ReportAccess& world) {
    list_touching(world, world.events.touching_now);
    if (world.events.touching_now == world.events.touching) return;
    auto now = world.events.touching_now.begin();
    const auto last = world.events.touching_now.end();
    for (const TouchingPair& pair : world.events.touching) {
        while (now != last && *now < pair) ++now;
        if (now == last || *now != pair) end_touching(world, pair);
    }
    auto before = world.events.touching.begin();
    for (const TouchingPair& pair : world.events.touching_now) {
        while (before != world.events.touching.end() && *before < pair) ++before;
        const bool is_new = before == world.events.touching.end() || *before != pair;
        if (is_new) world.events.contacts.push_back(begin_event(world, pair));
    }
    world.events.touching.swap(world.events.touching_now);
}

void count_bodies(const ReportAccess& world) {
    // Bodies that slept at the step's start still sleep, or were listed as awake since.
    world.report.bodies_asleep = world.activity.asleep_when_gathered;
    for (const std::uint32_t body : world.activity.awake) {
        if (!world.rigid.is_dynamic(body) || !world.rigid.record(body).definition.enabled) continue;
        switch (world.activity.sleep[body].state) {
            case SleepState::active:
                ++world.report.bodies_active;
                break;
            case SleepState::wants_to_sleep:
                ++world.report.bodies_wanting_to_sleep;
                break;
            case SleepState::asleep:
                ++world.report.bodies_asleep;
                break;
        }
    }
}

}  // namespace

void write_report(const ReportAccess& world) {
    world.events.contacts.clear();
    write_contact_events(world);
    count_bodies(world);
    for (const ContactSummary& contact : world.contacts.summaries) {
        if (contact.touches) ++world.report.contacts;
        if (contact.is_deep) world.report.limits |= static_cast<std::uint32_t>(StepLimit::deep_penetration);
    }
    for_each_awake(world, [&](std::uint32_t body) {
        world.rigid.record(body).next_force = world.rigid.record(body).next_torque = {};
    });
}

}  // namespace embody::physics::step
