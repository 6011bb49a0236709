// SPDX-License-Identifier: MIT
//
// Shock propagation (paper, section IV): from the bottom up, each object counts as infinitely heavy for the ones above
// it until the phase ends. Sources: E. Guendelman, R. Bridson, R. Fedkiw, "Nonconvex rigid bodies with stacking", 2003;
// K. Erleben, "Velocity-based shock propagation for multibody dynamics animation", 2007.
// Departure: taken literally, in the velocities, the upper bodies would no longer load the lower ones and a stack could
// not tip. So the velocities are solved with true masses, and only the rest of the penetration is taken out by shock
// propagation.
#include "physics/optimization/shock_propagation.h"

#include <algorithm>

namespace embody::physics::optimization {

namespace {

// What a unit impulse at the point does to its normal speed, 1/kg.
double response_of(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    const Vec3 n = contact.normal;
    return dot(n, inverse_mass_at(bodies[contact.a], point.arm_a, bodies[contact.b], point.arm_b) * n);
}

}  // namespace

void propagate_shock(const Island& island, const Islands& islands, std::span<const Contact> contacts,
                     const ShockRules& rules, std::span<BodyState> bodies) {
    if (island.deepest_level < rules.settings.shock_min_levels) return;
    for (std::uint32_t k = 0; k < island.contact_count; ++k) {
        const Contact& contact = contacts[islands.contacts[island.first_contact + k]];
        const std::uint32_t level_a = islands.level[contact.a], level_b = islands.level[contact.b];
        if (level_a == level_b || level_a == no_level || level_b == no_level || !is_pressed(contact)) continue;

        // The deepest point gives the displacement of the upper body; the body is only shifted, so that nothing starts
        // to turn.
        double depth = 0;
        for (int i = 0; i < contact.count; ++i) {
            const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            const double beyond = -current_separation(contact, point, bodies) - rules.softness.penetration_slop;
            if (beyond <= depth) continue;
            depth = std::max(depth, beyond - rules.softness.sag(response_of(contact, point, bodies), point.impulse));
        }
        if (depth <= 0) continue;
        const Vec3 shift = contact.normal * (rules.settings.shock_fraction * depth);
        if (level_b > level_a) {
            bodies[contact.b].center += shift;
        } else {
            bodies[contact.a].center -= shift;
        }
    }
}

}  // namespace embody::physics::optimization
