// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/collision/manifold.h"
#include "physics/dynamic/body_state.h"
#include "physics/inter/definitions/material.h"

namespace embody::physics {

/// What friction does over a contact region: a force along the two tangents at its anchor and a moment about the
/// normal, both times the substep.
struct PatchFriction {
    float along_1 = 0, along_2 = 0;  ///< N s
    float twist = 0;                 ///< N m s
};

// Contacts are what a step reads and writes most, so their numbers are floats: they are lengths from the bodies' own
// centres, speeds between two bodies and impulses, never places in the world.

struct ContactPoint {
    Vec3f arm_a, arm_b;      ///< from the centres of mass, world axes, when found; fixed during the step
    Vec3f local_a, local_b;  ///< the surface points, from the centres of mass in the bodies' axes
    float separation = 0;    ///< when found, m
    std::uint32_t feature = 0;

    float impulse = 0;         ///< along the normal, of the last substep; warm start of the next, N s
    float total = 0;           ///< along the normal, of the whole step, impacts included, N s
    float normal_mass = 0;     ///< what the point alone has to move along the normal, 1/(nᵀAn), kg
    float inactive_until = 0;  ///< s in the step: until then an impact lets the surfaces part, or they are not there
};

/// One contact region (paper, III.B) as a constraint between two bodies.
struct Contact {
    std::uint32_t a = 0, b = 0;              ///< body slots, a < b
    std::uint32_t piece_a = 0, piece_b = 0;  ///< convex pieces; with `part` the key of the region within the pair
    std::uint32_t part = 0;
    int count = 0;
    std::array<ContactPoint, Manifold::max_points> points;

    Vec3f normal, tangent_1, tangent_2;  ///< world; normal from a to b
    Vec3f local_normal;                  ///< in the axes of the body that it turns with
    PatchFriction friction;              ///< on b, of the last substep; warm start of the next
    PatchFriction friction_total;        ///< of the whole step, impacts included
    Vec3f rolling;                       ///< moment of rolling resistance on b, of the last substep, N m s, world
    bool sticks = true;                  ///< holds by static friction until its limit is left
    float approach_speed = 0;            ///< fastest point when found, m/s, >= 0
    bool turns_with_b = false;           ///< the normal does; else with a
    bool a_is_round = false, b_is_round = false;  ///< rolls: the point of contact does not turn with the body
    bool was_touching = false;                    ///< in the last step
    bool was_loaded = false;                      ///< pressed in the last step
    bool had_impact = false;                      ///< solved by the impact stage in this step
    Material material;                            ///< of the pair
};

/// What the impact stage must know of every contact, small enough to walk through all of them.
struct ContactGlance {
    std::uint32_t a = 0, b = 0;
    float approach_speed = 0;
    bool was_touching = false, was_loaded = false;
    bool bounces = false;
};
static_assert(sizeof(ContactGlance) == 16);

inline ContactGlance glance_at(const Contact& c) {
    return {c.a, c.b, c.approach_speed, c.was_touching, c.was_loaded, c.material.restitution > 0};
}

/// Arms to the middle of the region's points, where its friction acts.
struct Anchor {
    Vec3 arm_a, arm_b;
};
Anchor anchor_of(const Contact& contact);

/// Where the point was found, world.
inline Vec3 position_of(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    return bodies[contact.a].start_center + point.arm_a;
}

/// Same bodies and pieces, in the order contacts are kept.
inline std::array<std::uint32_t, 5> contact_key(const Contact& c) { return {c.a, c.b, c.piece_a, c.piece_b, c.part}; }

/// Frame and arms from what the narrow phase found.
Contact make_contact(std::uint32_t a, std::uint32_t b, const Manifold& manifold, std::span<const BodyState> bodies,
                     bool turns_with_b = false);

/// Follows the bodies of a contact that was found in an earlier step: its surface points stay where they are on each
/// body. Keeps impulses for the warm start, clears what belongs to a step.
void follow_bodies(Contact& contact, std::span<const BodyState> bodies);

/// Hands the last step's impulses to the new points that lie where an old one did (warm start; paper, contact caching).
void match_points(const Contact& old_contact, Contact& new_contact);

/// Velocity of b's matter relative to a's at the point.
inline Vec3 relative_velocity(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    return velocity_at(bodies[contact.b], point.arm_b) - velocity_at(bodies[contact.a], point.arm_a);
}

/// Gap at the point now, m, from the bodies' motion since it was found.
double current_separation(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies);

/// The friction of the whole step on b as a force at its anchor, world, N s.
inline Vec3 friction_force(const Contact& contact, const PatchFriction& friction) {
    return friction.along_1 * contact.tangent_1 + friction.along_2 * contact.tangent_2;
}

/// Whether it carried a load at the end of the last substep that solved it; impacts do not count.
bool is_pressed(const Contact& contact);

/// Whether the bodies touch: an impulse of the last step went through the region, or they overlapped when it was found.
bool is_touching(const Contact& contact);

/// A = J M⁻¹ Jᵀ of eq. (3) in the world axes: what a unit impulse on b (and its opposite on a) does to the relative
/// velocity, 1/kg.
Mat3 inverse_mass_at(const BodyState& a, Vec3 arm_a, const BodyState& b, Vec3 arm_b);

}  // namespace embody::physics
