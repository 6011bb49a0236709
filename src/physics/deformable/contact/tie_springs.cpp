// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/tie_springs.h"

#include <algorithm>

namespace embody::physics::deformable {

namespace {

// The two ends as a spring: nodes and weights, without a stiffness.
TouchSpring spring_of(const PlacedTie& placed) {
    const Tie& tie = *placed.tie;
    TouchSpring spring{.node = {placed.own_first + tie.node}, .weight = {1}, .is_attachment = true};
    for (std::size_t k = 0; k < 3; ++k) {
        if (tie.weight[k] == 0) continue;
        const auto at = static_cast<std::size_t>(spring.count++);
        spring.node[at] = placed.other_first + tie.other_nodes[k];
        spring.weight[at] = -tie.weight[k];
    }
    return spring;
}

}  // namespace

// As stiff as contacts between sheets and ropes, and for the same reasons (docs/physics/cloth.md).
void TieSprings::begin(std::span<const PlacedTie> ties, double h, double gravity, const ThinContactSettings& settings) {
    springs_.clear();
    pulls_.clear();
    for (const PlacedTie& placed : ties) {
        const Tie& tie = *placed.tie;
        TouchSpring spring = spring_of(placed);
        Vec3 apart = placed.own->position[tie.node];
        double mass = 0, compliance = placed.own->inverse_mass[tie.node];
        for (std::size_t k = 0; k < 3; ++k) {
            if (tie.weight[k] == 0) continue;
            apart -= tie.weight[k] * placed.other->position[tie.other_nodes[k]];
            mass += tie.weight[k] * placed.other->mass[tie.other_nodes[k]];
            compliance += tie.weight[k] * tie.weight[k] * placed.other->inverse_mass[tie.other_nodes[k]];
        }
        if (compliance == 0) continue;
        const double most = settings.recovery_speed * h, distance = length(apart);
        if (distance > most) apart *= most / distance;
        spring.stiffness =
            contact_stiffness(std::max(mass, placed.own->mass[tie.node]), length(*placed.pull), h, gravity, settings);
        spring.acts = true;
        spring.matrix = spring.stiffness * Mat3::identity();
        spring.load = *placed.pull - spring.stiffness * apart;
        springs_.push_back(spring);
        pulls_.push_back(placed.pull);
    }
}

void TieSprings::finish(std::span<const Vec3> moves) {
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        const TouchSpring& spring = springs_[i];
        *pulls_[i] = spring.force(spring.lead(moves, {}));
    }
}

}  // namespace embody::physics::deformable
