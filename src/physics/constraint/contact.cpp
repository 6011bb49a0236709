// SPDX-License-Identifier: MIT
#include "physics/constraint/contact.h"

#include <algorithm>

namespace embody::physics {

namespace {

void set_normal(Contact& contact, Vec3 normal) {
    const Vec3 tangent = any_perpendicular(normal);
    contact.normal = to_vec3f(normal);
    contact.tangent_1 = to_vec3f(tangent);
    contact.tangent_2 = to_vec3f(cross(normal, tangent));
}

// Arms to the middle between the surface points, and how fast they approach.
void set_arms(Contact& contact, ContactPoint& point, Vec3 arm_a, Vec3 arm_b, std::span<const BodyState> bodies) {
    point.arm_a = to_vec3f(arm_a);
    point.arm_b = to_vec3f(arm_b);
    const double speed = -dot(relative_velocity(contact, point, bodies), contact.normal);
    contact.approach_speed = std::max(contact.approach_speed, static_cast<float>(speed));
}

}  // namespace

Contact make_contact(std::uint32_t a, std::uint32_t b, const Manifold& manifold, std::span<const BodyState> bodies,
                     bool turns_with_b) {
    Contact contact;
    contact.a = a;
    contact.b = b;
    contact.piece_a = manifold.piece_a;
    contact.piece_b = manifold.piece_b;
    contact.part = manifold.part;
    contact.turns_with_b = turns_with_b;
    set_normal(contact, manifold.normal);
    contact.local_normal = to_vec3f(rotate_inverse(bodies[turns_with_b ? b : a].rotation, manifold.normal));
    contact.count = manifold.count;
    for (int i = 0; i < manifold.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const ManifoldPoint& found = manifold.points[static_cast<std::size_t>(i)];
        point.separation = static_cast<float>(found.separation);
        point.feature = found.feature;
        const Vec3 arm_a = found.position - bodies[a].center, arm_b = found.position - bodies[b].center;
        set_arms(contact, point, arm_a, arm_b, bodies);
        const Vec3 half_gap = manifold.normal * (0.5 * found.separation);
        point.local_a = to_vec3f(rotate_inverse(bodies[a].rotation, arm_a - half_gap));
        point.local_b = to_vec3f(rotate_inverse(bodies[b].rotation, arm_b + half_gap));
    }
    return contact;
}

namespace {

// The tangents of the two steps differ by a turn about the normal; the friction keeps its world direction. `shift`
// leads from the new anchor to the old one.
PatchFriction carried_over(const PatchFriction& friction, const Contact& new_contact, Vec3 old_1, Vec3 old_2,
                           Vec3 shift) {
    const Vec3 force = friction.along_1 * old_1 + friction.along_2 * old_2;
    return {static_cast<float>(dot(force, new_contact.tangent_1)),
            static_cast<float>(dot(force, new_contact.tangent_2)),
            static_cast<float>(friction.twist + dot(cross(shift, force), new_contact.normal))};
}

}  // namespace

Anchor anchor_of(const Contact& contact) {
    Anchor sum;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        sum.arm_a += point.arm_a;
        sum.arm_b += point.arm_b;
    }
    const double share = contact.count > 0 ? 1.0 / contact.count : 0;
    return {sum.arm_a * share, sum.arm_b * share};
}

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
            const double squared = length_squared(Vec3(old_point.local_a) - point.local_a);
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
        point.impulse = old_point.impulse;
    }

    // The bodies' last way is short beside the region: the old anchor is taken where it was.
    const Vec3 shift = anchor_of(old_contact).arm_a - anchor_of(new_contact).arm_a;
    new_contact.friction =
        carried_over(old_contact.friction, new_contact, old_contact.tangent_1, old_contact.tangent_2, shift);
    new_contact.sticks = old_contact.sticks;
    new_contact.rolling = old_contact.rolling;
    new_contact.was_touching = is_touching(old_contact);
    new_contact.was_loaded = is_pressed(old_contact);
}

void follow_bodies(Contact& contact, std::span<const BodyState> bodies) {
    const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
    contact.was_touching = is_touching(contact);
    contact.was_loaded = is_pressed(contact);
    contact.had_impact = false;

    // The normal, and how fast a point at an arm approaches: −n·(Δv + ω_b × arm_b − ω_a × arm_a).
    const Mat3 turn_a = to_matrix(a.rotation), turn_b = to_matrix(b.rotation);
    const Vec3 normal = (contact.turns_with_b ? turn_b : turn_a) * Vec3(contact.local_normal);
    const Vec3 old_1 = contact.tangent_1, old_2 = contact.tangent_2;
    set_normal(contact, normal);
    const double middle_speed = -dot(normal, b.linear_velocity - a.linear_velocity);
    const Vec3 by_arm_a = cross(normal, a.angular_velocity), by_arm_b = cross(normal, b.angular_velocity);
    const Vec3 apart = b.center - a.center;
    double fastest = 0;
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const Vec3 surface_a = turn_a * Vec3(point.local_a), surface_b = turn_b * Vec3(point.local_b);
        const Vec3 gap = apart + surface_b - surface_a, arm_a = surface_a + 0.5 * gap, arm_b = arm_a - apart;
        point.separation = static_cast<float>(dot(normal, gap));
        point.arm_a = to_vec3f(arm_a);
        point.arm_b = to_vec3f(arm_b);
        fastest = std::max(fastest, middle_speed + dot(by_arm_a, arm_a) - dot(by_arm_b, arm_b));
        point.total = 0;
        point.inactive_until = 0;
    }
    contact.approach_speed = static_cast<float>(fastest);
    contact.friction = carried_over(contact.friction, contact, old_1, old_2, {});
    contact.friction_total = {};
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

bool is_pressed(const Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        if (contact.points[static_cast<std::size_t>(i)].impulse > 0) return true;
    }
    return false;
}

bool is_touching(const Contact& contact) {
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        if (point.total > 0 || point.separation <= 0) return true;
    }
    return false;
}

Mat3 inverse_mass_at(const BodyState& a, Vec3 arm_a, const BodyState& b, Vec3 arm_b) {
    const Mat3 cross_a = skew(arm_a), cross_b = skew(arm_b);
    const Mat3 angular = cross_a * a.inverse_inertia * cross_a + cross_b * b.inverse_inertia * cross_b;
    return Mat3::identity() * (a.inverse_mass + b.inverse_mass) - angular;
}

}  // namespace embody::physics
