// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/body_supports.h"

#include <algorithm>
#include <variant>
#include <vector>

#include "physics/constraint/joint/joint.h"
#include "physics/definitions/world_settings.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

bool is_movable(const DeformableAccess& world, std::uint32_t slot) {
    return world.rigid.is_dynamic(slot) && !world.activity.is_asleep(slot);
}

// The bodies that get supports.
class BorneBodies {
public:
    BorneBodies(std::span<const SolidContact> of_solids, std::span<const ThinDeformable> thin,
                std::span<TouchedBody> bodies)
        : bodies_(bodies), is_borne_(bodies.size(), false) {
        const auto mark = [&](std::uint32_t number) {
            if (number < is_borne_.size()) is_borne_[number] = true;
        };
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
            if (bodies[b].expected_late_force != Vec3{} || bodies[b].expected_late_torque != Vec3{}) mark(b);
        }
        for (const ThinDeformable& one : thin) {
            if (one.record->cloth() == nullptr) continue;
            for (const NodeContact& contact : one.contacts) mark(contact.body);
            for (const SheetContact& contact : one.sheet_contacts) mark(contact.plane.body);
            for (const std::uint32_t body : one.attachment_bodies) mark(body);
        }
        for (const SolidContact& contact : of_solids) {
            if (!contact.has_body()) continue;
            mark(contact.body);
            bodies_[contact.body].touches_solid = true;
        }
    }

    // Null where the body of that slot is none of them.
    [[nodiscard]] TouchedBody* find(std::uint32_t slot) const {
        const auto found = std::ranges::lower_bound(bodies_, slot, {}, &TouchedBody::body);
        if (found == bodies_.end() || found->body != slot || !(found->inverse_mass > 0)) return nullptr;
        return &*found;
    }
    [[nodiscard]] bool gets_supports(const TouchedBody& body) const {
        return is_borne_[static_cast<std::size_t>(&body - bodies_.data())];
    }

private:
    std::span<TouchedBody> bodies_;
    std::vector<bool> is_borne_;
};

// The points of a contact bear the body on side a or b of it.
void add_contact(const DeformableAccess& world, const Contact& contact, bool is_a, TouchedBody& body) {
    const BodyState& bearer = world.rigid.motion[is_a ? contact.b : contact.a];
    const bool bearer_moves = !world.rigid.is_dynamic(is_a ? contact.b : contact.a);
    const double sign = is_a ? 1 : -1, dt = world.settings.time_step;
    double sum = 0;
    for (int k = 0; k < contact.count; ++k) sum += contact.points[static_cast<std::size_t>(k)].total;
    const Vec3 friction = friction_force(contact, contact.friction_total);  // on b, N s
    for (int k = 0; k < contact.count; ++k) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(k)];
        BodySupport support;
        support.anchor = Vec3(is_a ? point.arm_a : point.arm_b);
        support.turns = !(is_a ? contact.a_is_round : contact.b_is_round);
        support.normal = sign * Vec3(contact.normal);
        support.gap = point.separation;
        if (bearer_moves) support.velocity = velocity_at(bearer, Vec3(is_a ? point.arm_b : point.arm_a));
        support.friction = {contact.friction_static, contact.friction_dynamic};
        support.sticks = contact.sticks;
        support.path_force = (point.total / dt) * support.normal;
        if (sum > 0) support.path_force += (sign * point.total / (sum * dt)) * friction;
        support.force = support.path_force;
        body.supports.push_back(support);
    }
}

// Directions and places that a joint holds: points on the body about the joint's, as far from it as the body reaches.
void add_joint(const DeformableAccess& world, const Joint& joint, bool is_a, TouchedBody& body) {
    const Transform& local = is_a ? joint.local_a : joint.local_b;
    const Quat rotation = body.start.rotation;
    const Vec3 anchor = rotate(rotation, local.position);
    constexpr double min_reach = 0.01;  // m: of bodies without a shape, which turn about their hinges too
    const double reach = std::max(world.rigid.record(body.body).reach, min_reach);
    const auto axis = [&](Vec3 of_joint) { return rotate(rotation, rotate(local.rotation, of_joint)); };
    const Vec3 x = axis({1, 0, 0}), y = axis({0, 1, 0});
    const auto hold = [&](Vec3 at, const Mat3& held) {
        BodySupport support;
        support.anchor = anchor + at;
        support.is_joint = true;
        support.held = held;
        body.supports.push_back(support);
    };
    const Mat3 all = Mat3::identity();
    if (std::holds_alternative<BallJoint>(joint.kind)) {
        hold({}, all);
    } else if (std::holds_alternative<HingeJoint>(joint.kind)) {
        hold(reach * x, all);
        hold(-reach * x, all);
    } else {
        const bool slides = std::holds_alternative<SliderJoint>(joint.kind);
        const Mat3 held = slides ? all - outer(x, x) : all;
        for (const Vec3 at : {reach * x, -reach * x, reach * y}) hold(at, held);
    }
}

}  // namespace

void find_supports(const DeformableAccess& world, std::span<const SolidContact> of_solids,
                   std::span<const ThinDeformable> thin, std::span<TouchedBody> bodies) {
    if (bodies.empty()) return;
    const BorneBodies borne(of_solids, thin, bodies);
    const auto for_side = [&](std::uint32_t slot, bool pushes, bool stands, const auto& add) {
        TouchedBody* const body = borne.find(slot);
        if (body == nullptr) return;
        body->is_borne = body->is_borne || pushes;
        if (stands && borne.gets_supports(*body)) add(*body);
    };
    for (const Contact& contact : world.contacts.list) {
        double total = 0;
        for (int k = 0; k < contact.count; ++k) total += contact.points[static_cast<std::size_t>(k)].total;
        for (const bool is_a : {true, false}) {
            for_side(is_a ? contact.a : contact.b, total > 0, !is_movable(world, is_a ? contact.b : contact.a),
                     [&](TouchedBody& body) { add_contact(world, contact, is_a, body); });
        }
    }
    for (const Joint& joint : world.joints.active) {
        for_side(joint.b, true, joint.a_is_world || !is_movable(world, joint.a),
                 [&](TouchedBody& body) { add_joint(world, joint, false, body); });
        if (joint.a_is_world) continue;
        for_side(joint.a, true, !is_movable(world, joint.b),
                 [&](TouchedBody& body) { add_joint(world, joint, true, body); });
    }
    for (TouchedBody& body : bodies) body.set_borne_forces();
}

}  // namespace embody::physics::stages
