// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/collision/pairs/manifold.h"
#include "physics/constraint/namespace.h"
#include "physics/definitions/material.h"
#include "physics/definitions/settings/contact_settings.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// What friction does over a contact region: a force along the two tangents at its anchor and a moment about the
/// normal, both times the substep.
struct PatchFriction {
    float along_1 = 0, along_2 = 0;  ///< N s
    float twist = 0;                 ///< N m s
};

// Contacts are what a step reads and writes most, so their numbers are floats: they are lengths from the bodies' own
// centres, speeds between two bodies and impulses, never places in the world. They lie in rows of eight numbers, so
// that the wide solver takes up many contacts at once by transposing rows (contact_batch.h: ContactRow).

struct ContactPoint {
    // First row.
    Vec3f arm_a, arm_b;    ///< from the centres of mass, world axes, when found; fixed during the step
    float separation = 0;  ///< when found, m
    float impulse = 0;     ///< along the normal, of the last substep; warm start of the next, N s
    // Second row.
    Vec3f place;                 ///< surface point of the smaller body when the pair was compared, see FollowedPair
    float place_separation = 0;  ///< then, m
    float total = 0;             ///< along the normal, of the whole step, impacts included, N s
    float inactive_until = 0;    ///< s in the step: until then the surfaces separate after an impact, or are not there
                                 ///< yet
    std::uint32_t feature = 0;   ///< what it is on the two shapes
    float unused = 0;            ///< fills the row
};

/// One contact region (paper, III.B) as a constraint between two bodies.
struct alignas(64) Contact {
    // First row.
    std::uint32_t a = 0, b = 0;              ///< body slots, a < b
    std::uint32_t piece_a = 0, piece_b = 0;  ///< convex pieces; with `part` the key of the region within the pair
    std::uint8_t count = 0;                  ///< of points
    std::uint8_t part = 0;
    bool sticks : 1 = true;                               ///< holds by static friction until its limit is left
    bool b_is_larger : 1 = false;                         ///< see SeenFrom
    bool a_is_round : 1 = false, b_is_round : 1 = false;  ///< rolls: the point of contact does not turn with the body
    bool is_on_edge : 1 = false;                          ///< a ball on an edge or a corner
    bool are_balls : 1 = false;                           ///< both, and do not bounce: turns with the centres
    bool bounces : 1 = false;                             ///< has a restitution
    bool was_touching : 1 = false;                        ///< in the last step
    bool was_loaded : 1 = false;                          ///< pressed in the last step
    bool had_impact : 1 = false;                          ///< solved by the impact stage in this step
    Vec3f local_normal;                                   ///< in the axes of its SeenFrom
    // Second row.
    Vec3f normal, tangent_1;  ///< world; normal from a to b
    float friction_static = 0, friction_dynamic = 0;
    // Third row.
    PatchFriction friction;        ///< on b, of the last substep; warm start of the next
    PatchFriction friction_total;  ///< of the whole step, impacts included
    float friction_torsional = 0, friction_rolling = 0;
    // Fourth row.
    Vec3f rolling;                  ///< moment of rolling resistance on b, of the last substep, N m s, world
    float approach_speed = 0;       ///< fastest point when found, m/s, >= 0
    std::array<float, 4> unused{};  ///< fills the row

    std::array<ContactPoint, Manifold::max_points> points;
};
static_assert(sizeof(Contact) == 384);

inline Vec3 tangent_2(const Contact& contact) { return cross(Vec3(contact.normal), Vec3(contact.tangent_1)); }

/// Takes the coefficients of the pair.
void set_material(Contact& contact, const Material& material);

/// What most stages need of every contact, small enough for a pass over all contacts.
struct ContactSummary {
    std::uint32_t a = 0, b = 0;
    float approach_speed = 0;
    std::uint8_t count = 0;         ///< of points
    bool was_touching : 1 = false;  ///< in the last step
    bool was_loaded : 1 = false;
    bool bounces : 1 = false;
    bool is_deep : 1 = false;  ///< bodies were found to overlap deeply
    bool touches : 1 = false;  ///< in this step, once it was solved
    bool is_sunk : 1 = false;  ///< deeper than its load explains, once it was solved
    bool is_kept : 1 = false;  ///< as in the last step: both bodies stand
    bool is_idle : 1 = false;  ///< connects nothing: its bodies move freely and stay apart through the step
};
static_assert(sizeof(ContactSummary) == 16);

/// Summary of a contact that is not solved yet. Deep: penetrating by `deep_penetration`, m, or more.
ContactSummary summary_of(const Contact& contact, float deep_penetration);

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

/// The frame of a contact while it follows its bodies: that of the larger body, or other axes in which the contact's
/// normal stays constant as well.
struct SeenFrom {
    Quat axes;
    bool b_is_larger = false;
};

/// Frame and arms from what the narrow phase found.
Contact make_contact(std::uint32_t a, std::uint32_t b, const Manifold& manifold, std::span<const BodyState> bodies,
                     const SeenFrom& seen = {});

/// A pair of bodies in the frame of its contacts: that of the larger body, whose turning moves surface points the
/// least. All but the step's motion is in the axes of its SeenFrom, and small: so no digits are lost where a body's
/// centre is far from its surface.
struct FollowedPair {
    Vec3f shift;  ///< of the smaller body's centre of mass since the pair was compared, m
    Vec3f turn;   ///< of the smaller body since then, imaginary part of a quaternion whose real part is not negative
    float turn_w = 1;
    std::array<Vec3f, 3> axes;  ///< of the view, world
    Vec3f apart;                ///< from a's centre of mass to b's, m, world; so are the next three
    Vec3f velocity;             ///< of b's centre of mass relative to a's, m/s
    Vec3f spin_a, spin_b;       ///< rad/s
    bool has_ball = false;      ///< one is a ball: its point of contact moves with its centre along the other's surface
};

/// Clears what belongs to a step, and notes the contact's state at the end of the last step.
void begin_step(Contact& contact);

/// Follows the bodies of a contact that was found in an earlier step: its surface points stay where they are on each
/// body. Keeps impulses for the warm start, clears what belongs to a step.
void follow_bodies(Contact& contact, const FollowedPair& pair);

/// Hands the last step's impulses to the new points that lie where an old one did (warm start; paper, contact caching).
void match_points(const Contact& old_contact, Contact& new_contact, const ContactSettings& settings);

/// Velocity of b's matter relative to a's at the point.
inline Vec3 relative_velocity(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    return velocity_at(bodies[contact.b], point.arm_b) - velocity_at(bodies[contact.a], point.arm_a);
}

/// Gap at the point now, m, from the bodies' motion since it was found.
double current_separation(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies);

/// The friction of the whole step on b as a force at its anchor, world, N s.
inline Vec3 friction_force(const Contact& contact, const PatchFriction& friction) {
    return friction.along_1 * Vec3(contact.tangent_1) + friction.along_2 * tangent_2(contact);
}

/// Along the normal at the end of the last substep that solved it, N s; impacts do not count.
double load_of(const Contact& contact);
/// Whether it carried a load at the end of the last substep that solved it; impacts do not count.
bool is_pressed(const Contact& contact);

/// Whether the bodies touch: an impulse of the last step went through the region, or they overlapped when it was found.
bool is_touching(const Contact& contact);

/// A = J M⁻¹ Jᵀ of eq. (3) in the world axes: what a unit impulse on b (and its opposite on a) does to the relative
/// velocity, 1/kg.
Mat3 inverse_mass_at(const BodyState& a, Vec3 arm_a, const BodyState& b, Vec3 arm_b);

}  // namespace embody::physics::constraint
