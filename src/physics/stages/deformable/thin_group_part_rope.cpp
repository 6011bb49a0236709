// SPDX-License-Identifier: MIT
// What keeps a rope that touches itself from getting energy out of it (docs/physics/thin-contact.md, "Ropes with
// themselves").
#include <algorithm>

#include "physics/stages/deformable/thin_group_part.h"

namespace embody::physics::stages {

namespace {

constexpr double min_move = 1.0 / 64;  // part that a rope goes of its moves. Test: Knot.ARopeLiesOnItselfInAHeap

}  // namespace

// Of a rope alone: where it touches itself its contacts may give back more than had pressed them, for their springs are
// others by now and the solves may not have converged. So it goes, from rigid moves, only as far as it has no more
// energy than by these, without those contacts.
void ThinGroupPart::go_as_far_as_energy_lasts(std::span<const BodyInertia> inertias) {
    const std::span<const TouchSpring> touch = members_[0].touch.springs();
    const Nodes& nodes = members_[0].record().nodes();
    const std::vector<Vec3> full = moves_;
    const std::vector<BodyMove> body_full = body_moves_;
    const auto go = [&](std::span<const Vec3> rigid, double part) {
        for (std::size_t i = 0; i < moves_.size(); ++i) moves_[i] = rigid[i] + part * (full[i] - rigid[i]);
        for (std::size_t b = 0; b < body_moves_.size(); ++b)
            body_moves_[b] = {part * body_full[b].shift, part * body_full[b].turn};
        double sum = members_[0].record().rope()->energy(members_[0].substep, moves_);
        for (std::size_t b = 0; b < inertias.size(); ++b) sum += energy_of(inertias[b], body_moves_[b]);
        for (const TouchSpring& spring : touch) sum += energy_pressed(spring, moves_, body_moves_);
        return sum;
    };
    Vec3 momentum;
    double mass = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        momentum += nodes.mass[i] * nodes.mean_velocity[i];
        mass += nodes.mass[i];
    }
    // As a whole with its centre of mass, or not at all where that has less energy, as where it lies on something.
    rigid_moves_.assign(nodes.size(), {});
    double most = go(rigid_moves_, 0);
    const std::vector<Vec3> common(nodes.size(), (h_ / mass) * momentum);
    if (const double of_common = go(common, 0); members_[0].record().rope()->is_free() && of_common < most) {
        most = of_common;
        rigid_moves_ = common;
    }
    for (double part = 1; part >= min_move; part /= 2) {
        if (go(rigid_moves_, part) <= most) return;
    }
    go(rigid_moves_, 0);
}

// Of a rope that would pass through itself: goes less far from its rigid moves, which stretches it less than what
// the guard does.
void ThinGroupPart::shorten_moves() {
    const std::vector<Vec3> full = moves_;
    for (double part = 1; part >= min_move; part /= 2) {
        for (std::size_t i = 0; i < moves_.size(); ++i)
            moves_[i] = rigid_moves_[i] + part * (full[i] - rigid_moves_[i]);
        if (CrossingGuard(seen_, guarded_, world_.workers).find(moves_).empty()) return;
    }
    moves_ = full;
}

}  // namespace embody::physics::stages
