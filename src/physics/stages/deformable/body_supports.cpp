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

// The bodies that get supports: those beside sheets all of them, those that ropes alone push their joints.
class BorneBodies {
public:
    BorneBodies(std::span<const SolidContact> of_solids, std::span<const ThinDeformable> thin,
                std::span<TouchedBody> bodies)
        : bodies_(bodies), borne_(bodies.size(), Borne::no) {
        const auto mark = [&](std::uint32_t number, Borne by) {
            if (number < borne_.size()) borne_[number] = std::max(borne_[number], by);
        };
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
            if (bodies[b].expected_late_force != Vec3{} || bodies[b].expected_late_torque != Vec3{})
                mark(b, Borne::by_all);
        }
        for (const ThinDeformable& one : thin) {
            const Borne by = one.record->cloth() ? Borne::by_all : Borne::by_joints;
            for (const NodeContact& contact : one.contacts) mark(contact.body, by);
            for (const SheetContact& contact : one.sheet_contacts) mark(contact.plane.body, by);
            for (const SegmentContact& contact : one.segment_contacts) mark(contact.plane.body, by);
            for (const std::uint32_t body : one.attachment_bodies) mark(body, by);
        }
        for (const SolidContact& contact : of_solids) {
            if (!contact.has_body()) continue;
            mark(contact.body, Borne::by_all);
            bodies_[contact.body].touches_solid = true;
        }
    }

    // Null where the body of that slot is no dynamic one near deformables.
    [[nodiscard]] TouchedBody* find(std::uint32_t slot) const {
        const auto found = std::ranges::lower_bound(bodies_, slot, {}, &TouchedBody::body);
        if (found == bodies_.end() || found->body != slot || !(found->inverse_mass > 0)) return nullptr;
        return &*found;
    }
    [[nodiscard]] bool is_borne_by_contacts(const TouchedBody& body) const { return borne(body) == Borne::by_all; }
    [[nodiscard]] bool is_borne_by_joints(const TouchedBody& body) const { return borne(body) != Borne::no; }

private:
    enum class Borne : std::uint8_t { no, by_joints, by_all };

    [[nodiscard]] Borne borne(const TouchedBody& body) const {
        return borne_[static_cast<std::size_t>(&body - bodies_.data())];
    }

    std::span<TouchedBody> bodies_;
    std::vector<Borne> borne_;
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
    for (const Contact& contact : world.contacts.list) {
        double total = 0;
        for (int k = 0; k < contact.count; ++k) total += contact.points[static_cast<std::size_t>(k)].total;
        for (const bool is_a : {true, false}) {
            TouchedBody* const body = borne.find(is_a ? contact.a : contact.b);
            if (body == nullptr) continue;
            body->is_borne = body->is_borne || total > 0;
            if (!is_movable(world, is_a ? contact.b : contact.a) && borne.is_borne_by_contacts(*body))
                add_contact(world, contact, is_a, *body);
        }
    }
    for (const Joint& joint : world.joints.active) {
        for (const bool is_a : {true, false}) {
            if (is_a && joint.a_is_world) continue;
            TouchedBody* const body = borne.find(is_a ? joint.a : joint.b);
            if (body == nullptr) continue;
            body->is_borne = true;
            const bool stands = is_a ? !is_movable(world, joint.b) : joint.a_is_world || !is_movable(world, joint.a);
            if (stands && borne.is_borne_by_joints(*body)) add_joint(world, joint, is_a, *body);
        }
    }
    for (TouchedBody& body : bodies) body.set_borne_forces();
}

}  // namespace embody::physics::stages
