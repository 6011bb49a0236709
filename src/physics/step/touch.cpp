// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/step/step.h"
#include "physics/step/wake.h"

namespace embody::physics {

namespace {

// Points that are farther apart than this and will not meet within the step are not looked for, m.
constexpr double base_margin = 0.005;
// A sleeper is woken by what comes as near as this, m.
constexpr double wake_gap = 1e-4;

bool may_collide(const WorldState& world, std::uint32_t a, std::uint32_t b) {
    const BodyDefinition& da = world.record(a).definition;
    const BodyDefinition& db = world.record(b).definition;
    if (!da.enabled || !db.enabled) return false;
    if (!(da.collision_group & db.collision_mask) || !(db.collision_group & da.collision_mask)) return false;
    return world.jointed_pairs.empty() || !world.jointed_pairs.contains({a, b});
}

// Whether the body moves by itself: an awake dynamic body, or a kinematic one with a velocity.
bool is_moving(const WorldState& world, std::uint32_t body) {
    const BodyKind kind = world.record(body).definition.kind;
    if (kind == BodyKind::dynamic_body) return !world.is_asleep(body);
    return kind == BodyKind::kinematic_body &&
           (world.motion[body].linear_velocity != Vec3{} || world.motion[body].angular_velocity != Vec3{});
}

// How far the surfaces can approach each other within the step: the margin of the narrow phase.
double margin_of(const WorldState& world, std::uint32_t a, std::uint32_t b) {
    const double dt = world.settings.time_step;
    const BodyState& ma = world.motion[a];
    const BodyState& mb = world.motion[b];
    const Vec3 velocity = mb.linear_velocity - ma.linear_velocity;
    const Vec3 acceleration = (mb.inverse_mass > 0 ? world.constants[b].acceleration : Vec3{}) -
                              (ma.inverse_mass > 0 ? world.constants[a].acceleration : Vec3{});
    const double turning =
        length(ma.angular_velocity) * world.record(a).reach + length(mb.angular_velocity) * world.record(b).reach;
    const double travel = (length(velocity) + turning) * dt + length(acceleration) * dt * dt / 2;

    // Beyond the size of the movable body a contact normal says little; the continuous stage takes over there.
    double size = 1e300;
    if (ma.inverse_mass > 0) size = std::min(size, world.record(a).reach);
    if (mb.inverse_mass > 0) size = std::min(size, world.record(b).reach);
    return base_margin + std::min(travel, 2 * size);
}

void collide_pair(const WorldState& world, std::uint32_t a, std::uint32_t b, std::vector<Manifold>& manifolds) {
    manifolds.clear();
    collide(*world.record(a).shape, world.pose(a), *world.record(b).shape, world.pose(b), margin_of(world, a, b),
            manifolds);
}

// Whether some point of the contact is or comes within wake_gap in this step.
bool meets_in_step(const WorldState& world, const Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double approach = -dot(relative_velocity(contact, point, world.motion), contact.normal);
        if (point.separation - std::max(0.0, approach) * world.settings.time_step < wake_gap) return true;
    }
    return false;
}

// Wakes every sleeping group that an awake body is about to touch.
void wake_touched(WorldState& world, std::vector<Manifold>& manifolds) {
    if (world.sleepers.empty()) return;
    bool woke = false;
    for (const BroadPhase::Pair& pair : *world.pairs) {
        const bool a_sleeps = world.is_asleep(pair.a), b_sleeps = world.is_asleep(pair.b);
        if (a_sleeps == b_sleeps || !is_moving(world, a_sleeps ? pair.b : pair.a)) continue;
        if (!may_collide(world, pair.a, pair.b)) continue;
        collide_pair(world, pair.a, pair.b, manifolds);
        for (const Manifold& manifold : manifolds) {
            if (!meets_in_step(world, make_contact(pair.a, pair.b, manifold, world.motion))) continue;
            wake_group_of(world, a_sleeps ? pair.a : pair.b);
            woke = true;
            break;
        }
    }
    if (woke) gather_awake(world);
}

bool is_round(const WorldState& world, std::uint32_t body) {
    const ShapeDefinition& shape = world.record(body).shape->definition();
    return std::holds_alternative<SphereShape>(shape) || std::holds_alternative<CapsuleShape>(shape) ||
           std::holds_alternative<CylinderShape>(shape) || std::holds_alternative<ConeShape>(shape);
}

// Contacts of both steps are sorted by key, so one pass over the two finds all old partners.
void take_over_impulses(const std::vector<Contact>& last, std::vector<Contact>& contacts) {
    auto old_contact = last.begin();
    for (Contact& contact : contacts) {
        while (old_contact != last.end() && contact_key(*old_contact) < contact_key(contact)) ++old_contact;
        if (old_contact != last.end() && contact_key(*old_contact) == contact_key(contact)) {
            match_points(*old_contact, contact);
        }
    }
}

}  // namespace

void find_contacts(WorldState& world) {
    // From here on the bodies' motion tells how contacts change.
    std::vector<Manifold> manifolds;
    wake_touched(world, manifolds);
    for (const std::uint32_t body : world.awake) {
        BodyState& state = world.motion[body];
        state.start_center = state.center;
        state.start_rotation = state.rotation;
        state.turn = {};
    }

    world.last_contacts.swap(world.contacts);
    world.contacts.clear();
    for (const BroadPhase::Pair& pair : *world.pairs) {
        // One of the two must be able to answer an impulse, and neither may sleep.
        const bool a_moves = world.motion[pair.a].inverse_mass > 0, b_moves = world.motion[pair.b].inverse_mass > 0;
        if (!a_moves && !b_moves) continue;
        if (world.is_asleep(pair.a) || world.is_asleep(pair.b)) continue;
        if (!may_collide(world, pair.a, pair.b)) continue;
        collide_pair(world, pair.a, pair.b, manifolds);
        if (manifolds.empty()) continue;
        const Material material =
            combine(world.record(pair.a).definition.material, world.record(pair.b).definition.material);
        for (const Manifold& manifold : manifolds) {
            world.contacts.push_back(make_contact(pair.a, pair.b, manifold, world.motion));
            world.contacts.back().material = material;
            world.contacts.back().a_is_round = is_round(world, pair.a);
            world.contacts.back().b_is_round = is_round(world, pair.b);
        }
    }
    std::sort(world.contacts.begin(), world.contacts.end(),
              [](const Contact& a, const Contact& b) { return contact_key(a) < contact_key(b); });
    take_over_impulses(world.last_contacts, world.contacts);
}

}  // namespace embody::physics
