// SPDX-License-Identifier: MIT
// What bears the bodies on the rigid side, in the solve of the contacts of solids (docs/physics/coupling.md, "Supports
// in the deformable solve"): contacts in which the bearer, which gives way nowhere, stands in the place of a solid.
#include <algorithm>

#include "physics/deformable/solid/solid_contacts.h"

namespace embody::physics::deformable {

// Of the bodies that solids touch in this substep.
void SolidContacts::gather_supports(std::span<TouchedBody> bodies, double h, double time) {
    supports_.clear();
    std::vector<std::uint32_t> numbers;
    std::size_t count = 0;
    for (const Active& active : active_) {
        if (active.body == nullptr || !active.body->is_dynamic || active.body->supports.empty()) continue;
        numbers.push_back(active.contact->body);
    }
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    for (const std::uint32_t number : numbers) count += bodies[number].supports.size();
    supports_.reserve(count);  // active_ points to them
    for (const std::uint32_t number : numbers) {
        TouchedBody& body = bodies[number];
        body.is_settled = true;
        for (BodySupport& support : body.supports) {
            SolidContact& contact = supports_.emplace_back();
            contact.body = number;
            contact.friction = support.friction;
            contact.sticks = support.sticks;
            contact.holds = support.is_joint;
            contact.force = support.given;
            Active active;
            active.contact = &contact;
            active.body = &body;
            active.support = &support;
            place_support(active, h, time);
            active_.push_back(active);
        }
    }
}

// What the rigid step left of an overlap stays, and so does what has bounced off again; what it found apart must not
// come closer than to a touch (as contact/support_springs.cpp).
void SolidContacts::place_support(Active& active, double h, double time) {
    const TouchedBody& body = *active.body;
    const BodySupport& support = *active.support;
    const Mat3 rotation = body.rotation_at(time);
    active.arm = support.turns ? rotation * support.anchor : support.anchor;
    active.shift = body.shift;
    active.turn = body.turn;
    const Vec3 off = body.shift + cross(body.turn, active.arm);  // the path
    if (support.is_joint) {
        active.held = rotation * support.held * transpose(rotation);
        active.slid = -(active.held * off);
        return;
    }
    active.normal = support.normal;
    const Vec3 moved = body.path_displacement(time, support.anchor, support.turns) - time * support.velocity;
    const bool pushed = dot(support.force, support.normal) > 0;
    const double apart = pushed ? 0 : std::max(0.0, support.gap - dot(moved, support.normal));
    active.gap = apart - dot(off, support.normal);
    active.slid = h * support.velocity - body.displacement(h, time, active.arm);
}

void SolidContacts::end_supports() const {
    for (const Active& active : active_) {
        if (active.support == nullptr) continue;
        active.support->force = active.support->given = active.contact->force;
        active.support->sticks = active.contact->sticks;
        active.body->is_open = false;
    }
}

}  // namespace embody::physics::deformable
