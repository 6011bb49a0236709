// SPDX-License-Identifier: MIT
#include "physics/constraint/contact/contact.h"

#include <algorithm>

namespace embody::physics::constraint {

namespace {

// Arms to the middle between the surface points, and how fast they approach.
void set_arms(Contact& contact, ContactPoint& point, Vec3 arm_a, Vec3 arm_b, std::span<const BodyState> bodies) {
    point.arm_a = to_vec3f(arm_a);
    point.arm_b = to_vec3f(arm_b);
    const double speed = -dot(relative_velocity(contact, point, bodies), contact.normal);
    contact.approach_speed = std::max(contact.approach_speed, static_cast<float>(speed));
}

// Place of a contact between the two surfaces, as a fraction of the gap from a's to b's: midway, but on the surface of
// a body that rolls on something flat: where that has sunk in, its speed at the midpoint would not be that of its
// radius.
double place_in_gap(bool a_is_round, bool b_is_round) { return a_is_round == b_is_round ? 0.5 : b_is_round ? 1 : 0; }

}  // namespace

Contact make_contact(std::uint32_t a, std::uint32_t b, const Manifold& manifold, std::span<const BodyState> bodies,
                     const SeenFrom& seen) {
    Contact contact;
    contact.a = a;
    contact.b = b;
    contact.piece_a = manifold.piece_a;
    contact.piece_b = manifold.piece_b;
    contact.part = static_cast<std::uint8_t>(manifold.part);
    contact.b_is_larger = seen.b_is_larger;
    contact.normal = to_vec3f(manifold.normal);
    contact.tangent_1 = to_vec3f(any_perpendicular(manifold.normal));
    contact.local_normal = to_vec3f(rotate_inverse(seen.axes, manifold.normal));
    contact.count = static_cast<std::uint8_t>(manifold.count);
    contact.a_is_round = manifold.a_is_round;
    contact.b_is_round = manifold.b_is_round;
    contact.is_on_edge = manifold.is_on_edge;
    const double fraction = place_in_gap(manifold.a_is_round, manifold.b_is_round);
    for (int i = 0; i < manifold.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const ManifoldPoint& found = manifold.points[static_cast<std::size_t>(i)];
        point.separation = static_cast<float>(found.separation);
        point.feature = found.feature;
        const Vec3 gap = manifold.normal * found.separation, position = found.position + gap * (fraction - 0.5);
        const Vec3 arm_a = position - bodies[a].center, arm_b = position - bodies[b].center;
        set_arms(contact, point, arm_a, arm_b, bodies);
        const Vec3 place = seen.b_is_larger ? arm_a - gap * fraction : arm_b + gap * (1 - fraction);
        point.place = to_vec3f(rotate_inverse(seen.axes, place));
        point.place_separation = point.separation;
    }
    return contact;
}

void set_material(Contact& contact, const Material& material) {
    contact.friction_static = static_cast<float>(material.friction_static);
    contact.friction_dynamic = static_cast<float>(material.friction_dynamic);
    contact.friction_torsional = static_cast<float>(material.friction_torsional);
    // On an edge nothing carries the corners that a ball stands for.
    const double on_face = std::max(material.friction_rolling, material.friction_rolling_on_others);
    contact.friction_rolling = static_cast<float>(contact.is_on_edge ? material.friction_rolling : on_face);
    contact.bounces = material.restitution > 0;
}

ContactSummary summary_of(const Contact& contact, float deep_penetration) {
    ContactSummary summary{.a = contact.a,
                           .b = contact.b,
                           .approach_speed = contact.approach_speed,
                           .count = contact.count,
                           .was_touching = contact.was_touching,
                           .was_loaded = contact.was_loaded,
                           .bounces = contact.bounces};
    for (int i = 0; i < contact.count; ++i) {
        if (contact.points[static_cast<std::size_t>(i)].separation <= -deep_penetration) summary.is_deep = true;
    }
    return summary;
}

Anchor anchor_of(const Contact& contact) {
    Anchor sum;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        sum.arm_a += point.arm_a;
        sum.arm_b += point.arm_b;
    }
    const double fraction = contact.count > 0 ? 1.0 / contact.count : 0;
    return {sum.arm_a * fraction, sum.arm_b * fraction};
}

void match_points(const Contact& old_contact, Contact& new_contact, const ContactSettings& settings) {
    // Features identify the same point; where they changed, the nearest old point within reach replaces it.
    const double squared_reach = settings.match_reach * settings.match_reach;
    const double squared_ratio = settings.match_feature_ratio * settings.match_feature_ratio;
    std::array<bool, Manifold::max_points> taken{};
    for (int i = 0; i < new_contact.count; ++i) {
        ContactPoint& point = new_contact.points[static_cast<std::size_t>(i)];
        int best = -1;
        double best_distance = squared_reach;
        for (int j = 0; j < old_contact.count; ++j) {
            const ContactPoint& old_point = old_contact.points[static_cast<std::size_t>(j)];
            if (taken[static_cast<std::size_t>(j)]) continue;
            const double squared = length_squared(Vec3(old_point.place) - point.place);
            if (old_point.feature == point.feature &&
                squared < squared_ratio * settings.match_reach * settings.match_reach) {
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

    // The tangents of the two steps differ by a turn about the normal; the friction keeps its world direction. The
    // bodies' last travel is short beside the region: the old anchor is taken where it was.
    // That of two balls lies between their centres all the time.
    const Vec3 shift = new_contact.are_balls ? Vec3{} : anchor_of(old_contact).arm_a - anchor_of(new_contact).arm_a;
    const Vec3 force = friction_force(old_contact, old_contact.friction);
    new_contact.friction = {
        static_cast<float>(dot(force, new_contact.tangent_1)), static_cast<float>(dot(force, tangent_2(new_contact))),
        static_cast<float>(old_contact.friction.twist + dot(cross(shift, force), new_contact.normal))};
    new_contact.sticks = old_contact.sticks;
    new_contact.rolling = old_contact.rolling;
    new_contact.was_touching = is_touching(old_contact);
    new_contact.was_loaded = is_pressed(old_contact);
}

namespace {

// Four points of a region side by side.
using Four = float __attribute__((vector_size(16)));
struct Four3 {
    Four x, y, z;
};
Four all(float number) { return Four{} + number; }
Four3 all(Vec3f v) { return {all(v.x), all(v.y), all(v.z)}; }
Four3 operator+(const Four3& a, const Four3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Four3 operator-(const Four3& a, const Four3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Four3 operator*(const Four3& a, Four s) { return {a.x * s, a.y * s, a.z * s}; }
Four dot(const Four3& a, const Four3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Four3 cross(const Four3& a, const Four3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3f in_axes(const std::array<Vec3f, 3>& axes, Vec3f v) {
    return {axes[0].x * v.x + axes[1].x * v.y + axes[2].x * v.z, axes[0].y * v.x + axes[1].y * v.y + axes[2].y * v.z,
            axes[0].z * v.x + axes[1].z * v.y + axes[2].z * v.z};
}
Four3 in_axes(const std::array<Vec3f, 3>& axes, const Four3& v) {
    return all(axes[0]) * v.x + all(axes[1]) * v.y + all(axes[2]) * v.z;
}

// The tangent turns as little as it can, so that friction keeps its world direction.
void turn_frame(Contact& contact, Vec3f normal) {
    constexpr double nearly_one = 0.999;  // squared length: one step of Newton's is then right to 4e-7
    constexpr double min_across = 0.01;   // squared length: below, the tangent's direction has no meaning left
    const Vec3 n = normal, tangent = contact.tangent_1, across = tangent - dot(tangent, n) * n;
    const double squared = length_squared(across);
    contact.normal = normal;
    if (squared > nearly_one) {
        contact.tangent_1 = to_vec3f(across * (1.5 - 0.5 * squared));  // a step of Newton's for 1/√
    } else {
        contact.tangent_1 = to_vec3f(squared > min_across ? normalized(across) : any_perpendicular(n));
    }
}

}  // namespace

// With the smaller body's surface point s, its turn R and shift d since then, all in the larger body's axes: the point
// is now at R s from the smaller centre, and the gap vector has changed by d + R s − s, up to the sign of who is b. The
// contact is midway between the two surface points; of a ball (R = 1) midway on the normal through s, whose foot on the
// other surface has come along.
void begin_step(Contact& contact) {
    contact.was_touching = is_touching(contact);
    contact.was_loaded = is_pressed(contact);
    contact.had_impact = false;
    contact.friction_total = {};
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        point.total = 0;
        point.inactive_until = 0;
    }
}

void follow_bodies(Contact& contact, const FollowedPair& pair) {
    begin_step(contact);
    turn_frame(contact, in_axes(pair.axes, contact.local_normal));

    // Points to lanes; those that the region does not have repeat the last one.
    const auto last = static_cast<std::size_t>(contact.count - 1);
    Four3 place;
    Four separation;
    for (std::size_t i = 0; i < Manifold::max_points; ++i) {
        const ContactPoint& point = contact.points[std::min(i, last)];
        place.x[i] = point.place.x;
        place.y[i] = point.place.y;
        place.z[i] = point.place.z;
        separation[i] = point.place_separation;
    }

    const Four sign = all(contact.b_is_larger ? -1.0F : 1.0F);
    const Four3 by_tilt = cross(all(pair.turn), place) * all(2);
    const Four3 turned = by_tilt * all(pair.turn_w) + cross(all(pair.turn), by_tilt), change = all(pair.shift) + turned;
    const Four3 normal = all(contact.local_normal);
    const Four opening = dot(normal, change);
    const auto from_a = static_cast<float>(place_in_gap(contact.a_is_round, contact.b_is_round));
    const Four3 gap = normal * (separation * sign) + (pair.has_ball ? normal * opening : change);
    const Four3 to_contact = gap * all(contact.b_is_larger ? from_a : 1 - from_a);
    const Four3 arm_smaller = in_axes(pair.axes, place + turned - to_contact);
    const Four3 arm_larger = arm_smaller + all(pair.apart) * sign;
    const Four3 &arm_a = contact.b_is_larger ? arm_smaller : arm_larger,
                &arm_b = contact.b_is_larger ? arm_larger : arm_smaller;
    separation += sign * opening;

    // How fast a point approaches: −n·(Δv + ω_b × arm_b − ω_a × arm_a).
    const Four3 velocity = all(pair.velocity) + cross(all(pair.spin_b), arm_b) - cross(all(pair.spin_a), arm_a);
    const Four approach = -dot(all(contact.normal), velocity);
    float fastest = 0;
    for (std::size_t i = 0; i <= last; ++i) {
        ContactPoint& point = contact.points[i];
        point.arm_a = {arm_a.x[i], arm_a.y[i], arm_a.z[i]};
        point.arm_b = {arm_b.x[i], arm_b.y[i], arm_b.z[i]};
        point.separation = separation[i];
        fastest = std::max(fastest, approach[i]);
    }
    contact.approach_speed = fastest;
}

namespace {

// How the point at `arm` moved since it was found. When a round body rolls, other matter comes to the point, so only
// the tilt counts, to first order: exact turning would lift a rolling ball by r θ²/2.
Vec3 motion_of(const BodyState& body, Vec3 arm, bool is_round) {
    const Vec3 shift = body.center - body.start_center;
    if (!is_round) return shift + rotate(body.turn, arm) - arm;
    const double sign = body.turn.w < 0 ? -2 : 2;
    return shift + cross(sign * Vec3{body.turn.x, body.turn.y, body.turn.z}, arm);
}

}  // namespace

double current_separation(const Contact& contact, const ContactPoint& point, std::span<const BodyState> bodies) {
    if (contact.are_balls) {
        const BodyState &a = bodies[contact.a], &b = bodies[contact.b];
        return point.separation + distance(a.center, b.center) - distance(a.start_center, b.start_center);
    }
    const Vec3 move_a = motion_of(bodies[contact.a], point.arm_a, contact.a_is_round);
    const Vec3 move_b = motion_of(bodies[contact.b], point.arm_b, contact.b_is_round);
    return point.separation + dot(contact.normal, move_b - move_a);
}

double load_of(const Contact& contact) {
    float sum = 0;
    for (int i = 0; i < contact.count; ++i) sum += contact.points[static_cast<std::size_t>(i)].impulse;
    return sum;
}

bool is_pressed(const Contact& contact) { return load_of(contact) > 0; }

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

}  // namespace embody::physics::constraint
