// SPDX-License-Identifier: MIT
#include "physics/constraint/contact.h"

#include <algorithm>

namespace embody::physics {

Contact make_contact(std::uint32_t a, std::uint32_t b, const Manifold& manifold, std::span<const BodyState> bodies) {
    Contact contact;
    contact.a = a;
    contact.b = b;
    contact.piece_a = manifold.piece_a;
    contact.piece_b = manifold.piece_b;
    contact.normal = manifold.normal;
    contact.tangent_1 = any_perpendicular(manifold.normal);
    contact.tangent_2 = cross(manifold.normal, contact.tangent_1);
    contact.count = manifold.count;
    for (int i = 0; i < manifold.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const ManifoldPoint& found = manifold.points[static_cast<std::size_t>(i)];
        point.position = found.position;
        point.separation = found.separation;
        point.feature = found.feature;
        point.arm_a = found.position - bodies[a].center;
        point.arm_b = found.position - bodies[b].center;
        contact.approach_speed =
            std::max(contact.approach_speed, -dot(relative_velocity(contact, point, bodies), contact.normal));
    }
    return contact;
}

namespace {

// The tangents of the two steps differ by a turn about the normal; the friction impulse keeps its world direction.
PointImpulse carried_over(const PointImpulse& old_impulse, const Contact& old_contact, const Contact& new_contact) {
    const Vec3 friction = old_impulse.tangent_1 * old_contact.tangent_1 + old_impulse.tangent_2 * old_contact.tangent_2;
    return {old_impulse.normal, dot(friction, new_contact.tangent_1), dot(friction, new_contact.tangent_2)};
}

}  // namespace

void match_points(const Contact& old_contact, Contact& new_contact) {
    // Features tell the same point; where they changed, the nearest old point within reach stands in for it.
    constexpr double reach = 0.02;
    std::array<bool, Manifold::max_points> taken{};
    for (int i = 0; i < new_contact.count; ++i) {
        ContactPoint& point = new_contact.points[static_cast<std::size_t>(i)];
        int best = -1;
        double best_distance = reach * reach;
        for (int j = 0; j < old_contact.count; ++j) {
            const ContactPoint& old_point = old_contact.points[static_cast<std::size_t>(j)];
            if (taken[static_cast<std::size_t>(j)]) continue;
            const double squared = length_squared(old_point.position - point.position);
            if (old_point.feature == point.feature && squared < 25 * reach * reach) {
                best = j;
                break;
            }
            if (squared < best_distance) {
                best = j;
                best_distance = squared;
            }
        }
        if (best < 0) continue;
        const ContactPoint& old_point = old_contact.points[static_cast<std::size_t>(best)];
        taken[static_cast<std::size_t>(best)] = true;
        point.impulse = carried_over(old_point.impulse, old_contact, new_contact);
        point.sticks = old_point.sticks;
    }
    new_contact.turning = old_contact.turning;
    new_contact.was_touching = is_touching(old_contact);
    new_contact.was_loaded = is_pressed(old_contact);
}

namespace {

// How the point at `arm` moved since it was found. On a round body other matter has come to the point when it rolls, so
// only the tilt counts, to first order: exact turning would lift a rolling ball by r θ²/2.
Vec3 motion_of(const BodyState& body, Vec3 arm, bool is_round) {
    const Vec3 shift = body.center - body.start_center;
    if (!is_round) return shift + rotate(body.turn, arm) - arm;
    const double sign = body.turn.w < 0 ? -2 : 2;
    return shift + cross(sign * Vec3{body.turn.x, body.turn.y, body.turn.z}, arm);
}

}  // namespace

double current_separation(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    const Vec3 move_a = motion_of(bodies[contact.a], point.arm_a, contact.a_is_round);
    const Vec3 move_b = motion_of(bodies[contact.b], point.arm_b, contact.b_is_round);
    return point.separation + dot(contact.normal, move_b - move_a);
}

void activate_points(Contact& contact, double time) {
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        point.is_active = time > point.inactive_until;
        if (!point.is_active) point.impulse = {};
    }
}

bool is_pressed(const Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        if (contact.points[static_cast<std::size_t>(i)].impulse.normal > 0) return true;
    }
    return false;
}

bool is_touching(const Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        if (point.total.normal > 0 || point.separation <= 0) return true;
    }
    return false;
}

Mat3 inverse_mass_at(const BodyState& a, Vec3 arm_a, const BodyState& b, Vec3 arm_b) {
    const Mat3 cross_a = skew(arm_a), cross_b = skew(arm_b);
    const Mat3 angular = cross_a * a.inverse_inertia * cross_a + cross_b * b.inverse_inertia * cross_b;
    return Mat3::identity() * (a.inverse_mass + b.inverse_mass) - angular;
}

}  // namespace embody::physics
