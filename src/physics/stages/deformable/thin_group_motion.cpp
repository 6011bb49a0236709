// SPDX-License-Identifier: MIT
// Whether a substep is too long for the motion of its sheets: what the solved moves stretch them by unforeseen, and
// what the solve takes from those that bounce (docs/physics/cloth.md, "Where a sheet lands" and "Bounces").
#include <algorithm>

#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_group_part.h"

namespace embody::physics::stages {

namespace {

// m/s², not 0 in a world without gravity.
double gravity_for(const Substep& substep) {
    return std::max(length(substep.gravity), substep.settings.thin_contact.min_gravity);
}

}  // namespace

// The energy that the solved moves stretch a sheet by beyond what its linear equations say, over that of the motion of
// the sheet and of the bodies on it: where a corner stops some of the nodes, the others fly on across the sheet, which
// stretches it to second order only.
double ThinGroupPart::unforeseen_stretch(const Member& member, std::span<const TouchedBody> bodies) {
    const double stretch = member.record().cloth()->unforeseen_energy(part(moves_, member), world_.workers);
    return stretch > 0 ? stretch / energy_of_motion(member, bodies) : 0;
}

// Of a sheet and of the bodies on it, J: in a step of free fall from rest at least.
double ThinGroupPart::energy_of_motion(const Member& member, std::span<const TouchedBody> bodies) const {
    const ClothSheet& sheet = *member.record().cloth();
    const double gravity = gravity_for(member.substep);
    const double fall = h_ * h_ * gravity * gravity;  // m²/s²
    const Nodes& nodes = sheet.nodes();
    double motion = 0;  // J
    for (std::size_t i = 0; i < nodes.size(); ++i)
        motion += nodes.mass[i] / 2 * (length_squared(nodes.mean_velocity[i]) + fall);
    std::vector<bool> is_counted(bodies.size(), false);
    for (const TouchSpring& spring : member.touch.springs()) {
        if (!spring.acts || spring.body >= bodies.size() || is_counted[spring.body]) continue;
        is_counted[spring.body] = true;
        const TouchedBody& body = bodies[spring.body];
        if (body.inverse_mass > 0)
            motion += (length_squared(body.path_velocity + body.velocity) + fall) / (2 * body.inverse_mass);
    }
    return motion;
}

// A sheet with gas that falls is thrown back. Of a push j that changes the whole's velocity by Δv the solve takes
// ½ m j·Δv away (backward Euler), so that the sheet would lie where it lands if it were stopped in one substep. Says
// whether that is too much of its motion. At rest Δv is zero, in free fall j. What accelerates less than it falls
// rocks, and comes to rest.
bool ThinGroupPart::is_struck(std::span<const TouchedBody> bodies) const {
    constexpr double rocking = 0.5;  // of gravity. Test: SheetGas.BallsThatRockComeToRest
    for (const Member& member : std::span(members_).first(sheets_)) {
        const ClothSheet& sheet = *member.record().cloth();
        if (!sheet.gas().is_active()) continue;
        const std::span<const Vec3> moves = part(moves_, member);
        const Nodes& nodes = sheet.nodes();
        double mass = 0;
        Vec3 change;  // kg m/s
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            mass += nodes.mass[i];
            change += nodes.mass[i] * (moves[i] / h_ - nodes.mean_velocity[i]);
        }
        if (length(change) <= rocking * mass * h_ * gravity_for(member.substep)) continue;
        const double lost = length(change) * length(change / mass - h_ * member.substep.gravity) / 2;
        if (lost > world_.settings.solver.deformable.cloth.bounce_tolerance * energy_of_motion(member, bodies))
            return true;
    }
    return false;
}

// Makes the equations of sheets anew about the solved moves where these were not foreseen, or says that the substep
// must be taken in parts: where they stretch a sheet by more than its motion, or the last solve (`is_last`) still does.
ThinGroupPart::Stretch ThinGroupPart::linearize_again(bool is_last, bool may_cut, std::span<const TouchedBody> bodies) {
    const ClothSettings& settings = world_.settings.solver.deformable.cloth;
    Stretch found = Stretch::foreseen;
    for (std::size_t m = 0; m < sheets_; ++m) {
        const double stretch = unforeseen_stretch(members_[m], bodies);
        if (stretch <= settings.stretch_tolerance) continue;
        if (may_cut && (is_last || stretch > settings.max_stretch)) return Stretch::too_far;
        if (is_last) continue;
        members_[m].record().cloth()->linearize(members_[m].substep, part(moves_, members_[m]), world_.workers);
        found = Stretch::unforeseen;
    }
    return found;
}

}  // namespace embody::physics::stages
