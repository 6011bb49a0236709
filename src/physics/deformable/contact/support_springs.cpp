// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/support_springs.h"

#include <algorithm>

namespace embody::physics::deformable {

void SupportSprings::add(std::uint32_t number, std::size_t index, const TouchedBody& body, double mass,
                         const Substep& substep) {
    const BodySupport& support = body.supports[index];
    const double end = substep.time + substep.h, squared = substep.h * substep.h;
    const Mat3 rotation = body.rotation_at(end);
    TouchSpring spring{.count = 0, .body = number, .is_attachment = support.is_joint};
    spring.arm = support.turns ? rotation * support.anchor : support.anchor;
    spring.normal = support.is_joint ? Vec3{1, 0, 0} : support.normal;
    const Vec3 turning = cross(spring.arm, spring.normal);
    const double compliance = body.inverse_mass + dot(turning, body.inverse_inertia * turning);  // 1/kg
    spring.inertia = 1 / (compliance * squared);
    spring.stiffness =
        substep.settings.thin_contact.support_stiffness_factor * std::max(mass, 1 / compliance) / squared;
    const Vec3 off = body.shift + cross(body.turn, spring.arm);  // the path
    if (support.is_joint) {
        spring.matrix = spring.stiffness * (rotation * support.held * transpose(rotation));
        spring.load = support.force + spring.matrix * off;
        spring.acts = true;
    } else {
        const Vec3 moved = body.path_displacement(end, support.anchor, support.turns) - end * support.velocity;
        const double push = dot(support.force, support.normal);
        // What the rigid step left of an overlap stays, and so does what has bounced off again; what it found apart
        // must not come closer than to a touch.
        const double apart = push > 0 ? 0 : std::max(0.0, support.gap - dot(moved, support.normal));
        spring.gap = apart - dot(off, support.normal);
        spring.friction = support.friction;
        spring.sticks = support.sticks;
        spring.carried = body.displacement(substep.h, end, spring.arm) - substep.h * support.velocity;
        spring.pull = push * support.normal;
        spring.hold = -(1 / spring.stiffness) * across(support.force, support.normal);
    }
    contacts_.push_back(spring);
    sources_.push_back({number, index, support.given});
}

void SupportSprings::begin(std::span<const std::uint32_t> numbers, std::span<const TouchedBody> bodies, double mass,
                           const Substep& substep) {
    contacts_.clear();
    springs_.clear();
    sources_.clear();
    for (const std::uint32_t number : numbers) {
        for (std::size_t i = 0; i < bodies[number].supports.size(); ++i) add(number, i, bodies[number], mass, substep);
    }
}

void SupportSprings::begin(std::span<const TouchSpring> springs, std::span<const TouchedBody> bodies, double mass,
                           const Substep& substep) {
    std::vector<std::uint32_t> numbers;
    for (const TouchSpring& spring : springs) {
        if (spring.body != no_body && !bodies[spring.body].supports.empty()) numbers.push_back(spring.body);
    }
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    begin(numbers, bodies, mass, substep);
}

bool SupportSprings::choose(std::span<const BodyMove> body_moves, bool is_predicted, double tolerance) {
    bool has_changed = false;
    SpringChange sum;  // of one body: beside a heavy one any force on a light one is small
    springs_.resize(contacts_.size());
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (i > 0 && contacts_[i].body != contacts_[i - 1].body) sum = {};
        TouchSpring& contact = contacts_[i];
        if (!contact.is_attachment) choose_contact(contact, contact.lead({}, body_moves), is_predicted, sum);
        has_changed |= sum.change > tolerance * sum.near;
        springs_[i] = contact;
        springs_[i].load -= sources_[i].given;
        springs_[i].acts = springs_[i].is_attachment = true;
    }
    return has_changed;
}

void SupportSprings::finish(std::span<const BodyMove> body_moves, double h, std::span<TouchedBody> bodies,
                            std::span<const double> fractions) const {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const TouchSpring& contact = contacts_[i];
        TouchedBody& body = bodies[sources_[i].body];
        BodySupport& support = body.supports[sources_[i].support];
        const Vec3 given = sources_[i].given;
        Vec3 more = (contact.acts ? contact.force(contact.lead({}, body_moves)) : Vec3{}) - given;
        if (!fractions.empty()) more *= fractions[contact.body];
        const Vec3 force = given + more;
        body.bear(-h * more, contact.arm, h);
        support.force = force;
        support.impulse += h * force;
    }
}

}  // namespace embody::physics::deformable
