// SPDX-License-Identifier: MIT
#pragma once

#include "math/transform.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

/// The state of motion: the paper's state vector (q, R, v, ω) of section III.A, and what the constraints need to know
/// about the body's inertia. One a body, indexed by the body's slot. Immovable and kinematic bodies have zero inverse
/// masses.
struct BodyState {
    Vec3 center;            ///< of mass, world, m
    Quat rotation;          ///< of the body's axes
    Vec3 linear_velocity;   ///< of the centre of mass, m/s
    Vec3 angular_velocity;  ///< world axes, rad/s

    double inverse_mass = 0;              ///< 1/kg
    Mat3 inverse_inertia = Mat3::zero();  ///< world axes, at `rotation`, 1/(kg m²)

    Vec3 start_center;  ///< centre when this step's contacts were found; separations follow from the motion since
    Quat start_rotation;
    Quat turn;  ///< rotation since the contacts were found: rotation · start_rotation⁻¹

    Vec3 hidden_momentum;  ///< angular momentum that the midpoint velocity does not carry during a drift (see drift())
    double hidden_energy = 0;  ///< kinetic energy that the midpoint velocity does not carry, J
};

/// Neither fixed nor moved by the user: contacts and joints can move it.
inline bool is_movable(const BodyState& body) { return body.inverse_mass > 0; }

/// What stays constant while the body moves; read once a half step.
struct BodyConstants {
    double mass = 0;              ///< kg; 0 for bodies that forces do not move
    Vec3 local_center;            ///< centre of mass in the body's frame, m
    Mat3 inertia = Mat3::zero();  ///< about the centre of mass, body axes, kg m²
    Mat3 inverse_inertia = Mat3::zero();
    bool is_isotropic = false;   ///< inertia is a multiple of the identity: no gyroscopic torque
    Vec3 acceleration;           ///< by gravity and constant force, world, m/s²
    Vec3 torque;                 ///< constant, world, N m
    double linear_damping = 0;   ///< 1/s
    double angular_damping = 0;  ///< 1/s
};

/// Paper, eq. (1): the body's frame in the world, from its centre of mass and rotation.
inline Transform body_pose(const BodyState& state, Vec3 local_center) {
    return {state.center - rotate(state.rotation, local_center), state.rotation};
}

/// Velocity of the body's matter at `arm` from its centre of mass.
inline Vec3 velocity_at(const BodyState& state, Vec3 arm) {
    return state.linear_velocity + cross(state.angular_velocity, arm);
}

/// Paper, eq. (6): what an impulse at `arm` from the centre of mass does to the velocities.
inline void apply_impulse(BodyState& state, Vec3 impulse, Vec3 arm) {
    state.linear_velocity += impulse * state.inverse_mass;
    state.angular_velocity += state.inverse_inertia * cross(arm, impulse);
}

inline void apply_angular_impulse(BodyState& state, Vec3 impulse) {
    state.angular_velocity += state.inverse_inertia * impulse;
}

}  // namespace embody::physics::dynamic
