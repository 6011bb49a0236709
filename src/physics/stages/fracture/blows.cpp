// SPDX-License-Identifier: MIT
#include "physics/stages/fracture/blows.h"

#include <algorithm>
#include <numeric>

#include "physics/constraint/contact/contact.h"
#include "physics/dynamic/conserved.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/fracture_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

double normal_impulse(const Contact& contact) {
    double sum = 0;
    for (int i = 0; i < contact.count; ++i)
        sum += static_cast<double>(contact.points[static_cast<std::size_t>(i)].total);
    return sum;
}

// The contact's impulses on b as one at their middle; its moment about the normal is left out.
ContactImpulse impulse_of(const FractureAccess& world, const Contact& contact, double normal_sum) {
    ContactImpulse whole{contact.a, contact.b, {}, {}};
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const double weight = static_cast<double>(point.total) / normal_sum;
        whole.position += position_of(contact, point, world.rigid.motion) * weight;
    }
    whole.impulse = normal_sum * Vec3(contact.normal) + friction_force(contact, contact.friction_total);
    return whole;
}

Vec3 velocity_of(const FractureAccess& world, std::uint32_t body, Vec3 position) {
    const BodyState& state = world.rigid.motion[body];
    return velocity_at(state, position - state.center);
}

// Adds a contact's part in the blow on `body`. What only carries a load stops nothing: the impulse counts up to what
// changes the other body's speed of approach into the present one, with all of its mass.
void add_contact(const FractureAccess& world, const Contact& contact, std::uint32_t body, BlowOnBody& on) {
    const double pressed = normal_impulse(contact);
    const ContactImpulse whole = impulse_of(world, contact, pressed);
    on.contacts.push_back(whole);

    const Vec3 normal(contact.normal);
    const double approach = static_cast<double>(contact.approach_speed);
    const Vec3 apart = velocity_of(world, contact.b, whole.position) - velocity_of(world, contact.a, whole.position);
    const double change = approach + std::max(0.0, dot(apart, normal));
    const BodyState& other = world.rigid.motion[contact.a == body ? contact.b : contact.a];
    const BodyState& stopped = is_movable(other) ? other : world.rigid.motion[body];
    const double impulse = std::min(pressed, change / stopped.inverse_mass);
    if (!(impulse > 0)) return;
    Blow& blow = on.blow;
    blow.impulse += impulse;
    blow.energy += 0.5 * impulse * approach * approach / change;
    blow.position += (whole.position - blow.position) * (impulse / blow.impulse);
}

// An impact on a flat region is noted at one of its points. So the places of all contacts are moved together until
// their moments are what has changed the body's spin.
void correct_places(const FractureAccess& world, std::uint32_t body, BlowOnBody& on) {
    const BodyState &before = world.fracture.before[body], &now = world.rigid.motion[body];
    const BodyConstants& constants = world.rigid.constants[body];
    Vec3 missing = spin_momentum(now, constants) - spin_momentum(before, constants);
    Vec3 sum;
    for (const ContactImpulse& contact : on.contacts) {
        const Vec3 impulse = contact.b == body ? contact.impulse : -contact.impulse;
        missing -= cross(contact.position - now.center, impulse);
        sum += impulse;
    }
    const Vec3 shift = cross(sum, missing) / std::max(length_squared(sum), 1e-300);
    // Pressed from both sides nearly alike, it would be moved far.
    if (!(length(shift) <= world.rigid.record(body).reach)) return;
    for (ContactImpulse& contact : on.contacts) contact.position += shift;
    on.blow.position += shift;
}

}  // namespace

std::map<std::uint32_t, BlowOnBody> find_blows(const FractureAccess& world) {
    std::map<std::uint32_t, BlowOnBody> blows;
    for (const Contact& contact : world.contacts.list) {
        const bool of_a = world.rigid.brittle.contains(contact.a), of_b = world.rigid.brittle.contains(contact.b);
        if ((!of_a && !of_b) || !(normal_impulse(contact) > 0)) continue;
        if (of_a) add_contact(world, contact, contact.a, blows[contact.a]);
        if (of_b) add_contact(world, contact, contact.b, blows[contact.b]);
    }
    for (auto& [body, on] : blows) correct_places(world, body, on);
    return blows;
}

double driven_work(const FractureAccess& world, const ContactImpulse& contact, std::uint32_t body) {
    const std::uint32_t other = contact.a == body ? contact.b : contact.a;
    if (is_movable(world.rigid.motion[other])) return 0;
    const double sign = contact.b == body ? 1 : -1;
    return sign * dot(contact.impulse, velocity_of(world, other, contact.position));
}

StepLosses::StepLosses(const FractureAccess& world)
    : world_(world), roots_(world.rigid.motion.size()), driven_(world.rigid.motion.size()) {
    std::iota(roots_.begin(), roots_.end(), 0u);
    const auto root_of = [&](std::uint32_t body) {
        while (roots_[body] != body) body = roots_[body] = roots_[roots_[body]];
        return body;
    };
    const auto connect = [&](std::uint32_t a, std::uint32_t b) {
        if (!is_movable(world.rigid.motion[a]) || !is_movable(world.rigid.motion[b])) return;
        const std::uint32_t root_a = root_of(a), root_b = root_of(b);
        roots_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    };
    for (const Contact& contact : world.contacts.list) {
        const double pressed = normal_impulse(contact);
        if (!(pressed > 0)) continue;
        connect(contact.a, contact.b);
        const ContactImpulse whole = impulse_of(world, contact, pressed);
        for (const std::uint32_t body : {contact.a, contact.b})
            if (is_movable(world.rigid.motion[body])) driven_[body] += driven_work(world, whole, body);
    }
    for (const Joint& joint : world.joints.active)
        if (!joint.a_is_world) connect(joint.a, joint.b);
    for (std::uint32_t body = 0; body < roots_.size(); ++body) roots_[body] = root_of(body);
}

double StepLosses::of(std::uint32_t body) const {
    double loss = 0;
    for (const std::uint32_t other : world_.activity.awake) {
        if (!are_connected(body, other) || !world_.rigid.is_dynamic(other)) continue;
        const BodyState &before = world_.fracture.before[other], &now = world_.rigid.motion[other];
        const BodyConstants& constants = world_.rigid.constants[other];
        loss += kinetic_energy(before, constants) - kinetic_energy(now, constants) +
                constants.mass * dot(constants.acceleration, now.center - before.center) + driven_[other];
    }
    return loss;
}

}  // namespace embody::physics::stages
