// SPDX-License-Identifier: MIT
//
// Shock propagation (paper, section IV): from the bottom up, each object counts as infinitely heavy for the ones above
// it until the phase ends. Sources: E. Guendelman, R. Bridson, R. Fedkiw, "Nonconvex rigid bodies with stacking", 2003;
// K. Erleben, "Velocity-based shock propagation for multibody dynamics animation", 2007.
// Departure: taken literally, in the velocities, the upper bodies would no longer load the lower ones and a stack could
// not tip. So the velocities are solved with true masses, and only what is left of the penetration is taken out this
// way.
#include "physics/optimization/shock_propagation.h"

#include <algorithm>

namespace embody::physics {

namespace {

constexpr std::uint32_t deep = 4;   // levels from which the solver's own correction is too slow
constexpr double tolerance = 2e-5;  // m of penetration that may stay: keeps the contact pressed
constexpr double share = 0.3;       // of the rest taken out in one step

}  // namespace

void propagate_shock(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                     std::span<BodyState> bodies) {
    if (island.deepest_level < deep) return;
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = contacts[islands.contacts[island.first_contact + k]];
        const std::uint32_t level_a = islands.level[contact.a], level_b = islands.level[contact.b];
        if (level_a == level_b || level_a == no_level || level_b == no_level || !is_pressed(contact)) continue;

        // The deepest point tells how far the upper body has to go; it only shifts, so that nothing starts to turn.
        double deepest = 0;
        for (int i = 0; i < contact.count; ++i) {
            deepest =
                std::min(deepest, current_separation(contact, contact.points[static_cast<std::size_t>(i)], bodies));
        }
        const double depth = -deepest - tolerance;
        if (depth <= 0) continue;
        const Vec3 shift = contact.normal * (share * depth);
        if (level_b > level_a) {
            bodies[contact.b].center += shift;
        } else {
            bodies[contact.a].center -= shift;
        }
    }
}

}  // namespace embody::physics
