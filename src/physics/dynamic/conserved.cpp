// SPDX-License-Identifier: MIT
#include "physics/dynamic/conserved.h"

namespace embody::physics::dynamic {

Vec3 spin_momentum(const BodyState& state, const BodyConstants& constants) {
    const Vec3 omega = rotate_inverse(state.rotation, state.angular_velocity);
    return rotate(state.rotation, constants.inertia * omega);
}

double kinetic_energy(const BodyState& state, const BodyConstants& constants) {
    return 0.5 * constants.mass * length_squared(state.linear_velocity) +
           0.5 * dot(state.angular_velocity, spin_momentum(state, constants));
}

void add_conserved(Conserved& sum, const BodyState& state, const BodyConstants& constants, Vec3 gravity) {
    const Vec3 momentum = constants.mass * state.linear_velocity;
    sum.kinetic_energy += kinetic_energy(state, constants);
    sum.potential_energy -= constants.mass * dot(gravity, state.center);
    sum.linear_momentum += momentum;
    sum.angular_momentum += cross(state.center, momentum) + spin_momentum(state, constants);
}

}  // namespace embody::physics::dynamic
