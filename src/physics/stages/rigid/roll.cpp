// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/roll.h"

#include <algorithm>

#include "physics/collision/pairs/round_features.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/constraint/rolling/rolling_body.h"
#include "physics/definitions/world_settings.h"
#include "physics/optimization/islands.h"
#include "physics/stages/access.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

constexpr double same_normal = 1 - 1e-9;  // cosine: 4e-5 rad; a mesh's floats leave 1e-7 of a flat face
constexpr double aligned = 1e-6;  // sine, fraction of the size: within this, pieces lie on one axis; definitions round
                                  // to below 1e-7

// Adds the rings of a piece with that centre (from the centre of mass, body axes).
bool add_rings(const Convex& shape, Vec3 middle, Vec3 axis, RollingBody& body) {
    if (body.ring_count + 2 > RollingBody::max_rings) return false;
    const Vec3 half = axis * shape.half_height;
    switch (shape.kind) {
        case ConvexKind::sphere:
            body.add({middle, 0, shape.radius});
            return true;
        case ConvexKind::capsule:
            body.add({middle - half, 0, shape.radius});
            body.add({middle + half, 0, shape.radius});
            return true;
        case ConvexKind::cylinder:
            body.add({middle - half, shape.radius});
            body.add({middle + half, shape.radius});
            return true;
        case ConvexKind::cone:
            body.add({middle - half, shape.radius});
            body.add({middle + half});
            return true;
        case ConvexKind::polytope:
            break;
    }
    return false;
}

// The body as rings, if all its pieces are round about one axis; balls roll without rings.
std::optional<RollingBody> rolling_body(const SubstepAccess& world, std::uint32_t body) {
    const BodyRecord& record = world.rigid.record(body);
    if (!record.is_round || record.is_ball) return std::nullopt;
    const std::vector<ConvexPiece>& pieces = record.shape->data().pieces;
    const auto along_axis = [](const ConvexPiece& piece) { return rotate(piece.local.rotation, {0, 1, 0}); };
    const auto with_axis = std::find_if(
        pieces.begin(), pieces.end(), [](const ConvexPiece& piece) { return piece.convex.kind != ConvexKind::sphere; });
    if (with_axis == pieces.end()) return std::nullopt;
    RollingBody rolling{.axis = along_axis(*with_axis), .size = record.reach};
    const Vec3 start = with_axis->local.position;
    for (const ConvexPiece& piece : pieces) {
        const Vec3 own = along_axis(piece), aside = cross(piece.local.position - start, rolling.axis);
        const bool is_aligned = piece.convex.kind == ConvexKind::sphere || length(cross(own, rolling.axis)) < aligned;
        if (!is_aligned || length(aside) > aligned * record.reach) return std::nullopt;
        if (!add_rings(piece.convex, piece.local.position - world.rigid.constants[body].local_center, own, rolling)) {
            return std::nullopt;
        }
    }
    return rolling;
}

// Whether the contact's normal is that of a face of the ground: on an edge or a curve the body would roll differently.
bool lies_on_face(const SubstepAccess& world, std::uint32_t ground, std::uint32_t piece, Vec3 up) {
    const CollisionShape::Data& shape = world.rigid.record(ground).shape->data();
    if (shape.is_plane) return true;
    const Transform pose = world.rigid.pose(ground);
    if (shape.surface) return dot(rotate(pose.rotation, shape.surface->normal(piece)), up) >= same_normal;
    return has_aligned_face(place(shape.pieces[piece], pose, pose.position), up, same_normal);
}

// The still ground that all of the island's contacts lie on; none if they differ or resist rolling.
std::optional<DeepestPoint> deepest_on_flat_ground(const SubstepAccess& world, std::span<const std::uint32_t> contacts,
                                                   std::uint32_t body) {
    std::optional<DeepestPoint> deepest;
    float least = 0;
    const auto up_from = [&](const Contact& contact) {
        return normalized(Vec3(contact.normal)) * (contact.b == body ? 1.0 : -1.0);
    };
    const Vec3 first_up = up_from(world.contacts.list[contacts.front()]);
    for (const std::uint32_t index : contacts) {
        const Contact& contact = world.contacts.list[index];
        const std::uint32_t other = contact.a == body ? contact.b : contact.a;
        const BodyState& ground = world.rigid.motion[other];
        const bool is_still =
            ground.inverse_mass == 0 && ground.linear_velocity == Vec3{} && ground.angular_velocity == Vec3{};
        const bool resists = contact.friction_rolling > 0 || contact.friction_torsional > 0 || contact.had_impact;
        const std::uint32_t ground_piece = contact.a == body ? contact.piece_b : contact.piece_a;
        const Vec3 up = up_from(contact);
        if (!is_still || resists || dot(up, first_up) < same_normal) return std::nullopt;
        if (!lies_on_face(world, other, ground_piece, up)) return std::nullopt;
        for (std::size_t i = 0; i < contact.count; ++i) {
            const ContactPoint& point = contact.points[i];
            if (point.inactive_until > 0) return std::nullopt;
            if (deepest && point.separation >= least) continue;
            deepest = {index, i};
            least = point.separation;
        }
    }
    return deepest;
}

}  // namespace

void note_load(const WorldSettings& settings, std::span<const std::uint32_t> contacts, const DeepestPoint& deepest,
               Vec3 impulse, std::vector<Contact>& list) {
    const ContactPlan plan = contact_plan(contacts.size(), settings.substeps, settings.solver.constraint.contact);
    const auto part = static_cast<float>(1.0 / plan.substeps);
    for (const std::uint32_t index : contacts) {
        Contact& contact = list[index];
        contact.friction = {};
        contact.rolling = {};
        for (ContactPoint& point : contact.points) point.impulse = 0;
    }
    Contact& contact = list[deepest.contact];
    ContactPoint& point = contact.points[deepest.point];
    const auto along = [&](Vec3 direction) { return static_cast<float>(dot(impulse, direction)); };
    const PatchFriction friction{along(contact.tangent_1), along(tangent_2(contact)), 0};
    point.total += along(contact.normal);
    point.impulse = along(contact.normal) * part;
    contact.friction = {friction.along_1 * part, friction.along_2 * part, 0};
    contact.friction_total.along_1 += friction.along_1;
    contact.friction_total.along_2 += friction.along_2;
    contact.sticks = true;
}

bool roll_alone(const SubstepAccess& world, const Island& island) {
    const RollingSettings& settings = world.settings.solver.constraint.rolling;
    if (island.body_count != 1 || island.joint_count > 0 || island.contact_count > settings.body.max_contacts)
        return false;
    const std::uint32_t body = world.islands.bodies[island.first_body];
    const BodyConstants& constants = world.rigid.constants[body];
    if (constants.torque != Vec3{} || constants.linear_damping > 0 || constants.angular_damping > 0) return false;
    const std::optional<RollingBody> round = rolling_body(world, body);
    if (!round) return false;
    const auto contacts = std::span(world.islands.contacts).subspan(island.first_contact, island.contact_count);
    const std::optional<DeepestPoint> deepest = deepest_on_flat_ground(world, contacts, body);
    if (!deepest) return false;

    const Contact& contact = world.contacts.list[deepest->contact];
    const ContactPoint& point = contact.points[deepest->point];
    const bool is_b = contact.b == body;
    const Vec3 up = normalized(Vec3(contact.normal) * (is_b ? 1.0 : -1.0));
    BodyState& state = world.rigid.motion[body];
    const Vec3 on_body = state.center + Vec3(is_b ? point.arm_b : point.arm_a);
    const RollingGround ground{up, on_body - up * point.separation, contact.friction_static, contact.sticks};
    const std::optional<Vec3> impulse = roll(state, constants, *round, ground, {world.settings.time_step, settings});
    if (!impulse) return false;
    note_load(world.settings, contacts, *deepest, *impulse * (is_b ? 1.0 : -1.0), world.contacts.list);
    return true;
}

}  // namespace embody::physics::stages
