// SPDX-License-Identifier: MIT
//
// The spin of bodies that joints hold on an axis of symmetry only: taken out before a substep, as it does not act on
// the joints, and put back with the drift (own_spin.h; docs/physics/joints.md).
#include "physics/constraint/joint/joint_system.h"
#include "physics/dynamic/equations_of_motion.h"

namespace embody::physics::constraint {

// Bodies that joints hold on one axis of symmetry only.
void JointSystem::find_spin_axes(const View& view) {
    for (Body& body : bodies_) {
        body.spin_axis = {};
        body.own_spin = {};
    }
    const auto visit_ends = [&](auto visit) {
        for (const Place& place : places_) {
            const Joint& joint = view.joints[place.joint];
            if (place.a >= 0) visit(bodies_[static_cast<std::size_t>(place.a)], joint, joint.local_a);
            if (place.b >= 0) visit(bodies_[static_cast<std::size_t>(place.b)], joint, joint.local_b);
        }
    };
    constexpr double hinge_weight = 1e6;  // a hinge's axis is safer than an anchor, which may be the centre of mass
    const auto hinge_axis = [](const Transform& frame) { return rotate(frame.rotation, {1, 0, 0}); };
    visit_ends([&](Body& body, const Joint& joint, const Transform& frame) {
        const bool is_hinge = std::holds_alternative<HingeJoint>(joint.kind);
        const Vec3 direction = is_hinge ? hinge_axis(frame) * hinge_weight : frame.position;
        if (length_squared(direction) > length_squared(body.spin_axis)) body.spin_axis = direction;
    });
    for (Body& body : bodies_) body.spin_axis = symmetry_axis_along(body.spin_axis, view.constants[body.slot]);
    visit_ends([&](Body& body, const Joint& joint, const Transform& frame) {
        const auto* hinge = std::get_if<HingeJoint>(&joint.kind);
        const bool turns_freely =
            hinge && !hinge->limit && !hinge->motor && is_on_axis(hinge_axis(frame), body.spin_axis);
        const bool leaves_spin = turns_freely || std::holds_alternative<BallJoint>(joint.kind);
        if (!leaves_spin || !is_on_axis(frame.position, body.spin_axis)) body.spin_axis = {};
    });
}

// Before the motion of a substep: takes out the spin that does not act on the joints, or else applies Euler's equations
// alone.
void JointSystem::take_spin_aside(Body& body, double time, const View& view) {
    BodyState& state = view.bodies[body.slot];
    const BodyConstants& constants = view.constants[body.slot];
    body.own_spin = own_spin_of(state, constants, body.spin_axis, time);
    if (body.own_spin.rate == 0) {
        split_gyroscopic(state, constants, time);
        return;
    }
    state.angular_velocity -= rotate(state.rotation, body.spin_axis) * body.own_spin.rate;
    state.hidden_momentum = {};
}

// The body turns by its own spin and, with the axis, by the rest; its momentum stands still in the world.
void JointSystem::drift_spinning(Body& body, const View& view) {
    BodyState& state = view.bodies[body.slot];
    const Vec3 momentum = body.inertia * state.angular_velocity + state.hidden_momentum;
    state.center += state.linear_velocity * substep_;
    state.rotation = normalized(cayley(state.angular_velocity * substep_) * state.rotation * body.own_spin.turn);
    state.turn = state.rotation * conjugate(state.start_rotation);
    refresh_inertia(state, view.constants[body.slot]);
    state.angular_velocity = state.inverse_inertia * momentum;
    state.hidden_momentum = {};
    body.own_spin = {};
}

}  // namespace embody::physics::constraint
