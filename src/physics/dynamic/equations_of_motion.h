// SPDX-License-Identifier: MIT
#pragma once

#include "physics/dynamic/body_state.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

// One substep of a free body is kick(h/2), split_gyroscopic(h), drift(h), kick(h/2). Constraints act between the kick
// and the drift, where the velocity is the substep's mean, and again after the last kick.

/// Half of the substep's forces: gravity, constant force and torque, damping. `time` is h/2, s.
void kick(BodyState& state, const BodyConstants& constants, double time);

/// Turns the angular velocity into the mean over the coming drift of `time` (implicit midpoint of Euler's equations).
void split_gyroscopic(BodyState& state, const BodyConstants& constants, double time);

/// The same for a drift in which the body turns `parts` times by the mean velocity over time / parts. Does nothing
/// where it would turn by more than five twelfths of a circle: then the midpoint rule has no meaning.
void split_gyroscopic_of_turns(BodyState& state, const BodyConstants& constants, double time, int parts);

/// Sets the rotation to `turn` · start_rotation, and the angular velocity to that of the turned body: from the momentum
/// that split_gyroscopic_of_turns() hid, and never with more energy than the split left and contacts gave to the mean
/// velocity. A turn by other velocities than the split's (contacts change them) does not solve Euler's equations, and a
/// thin rod would gain energy from each such mismatch.
void finish_turn(BodyState& state, const BodyConstants& constants, Quat turn);

/// Moves the body by its mean velocities over `time` and turns the angular velocity into the one at the end.
void drift(BodyState& state, const BodyConstants& constants, double time);

/// Free flight over `time` (s): one substep without constraints, in parts where the body spins fast. A negative time
/// goes back along the same path. Energy and angular momentum are kept to 1e-12 in both directions.
void fly(BodyState& state, const BodyConstants& constants, double time);
/// As fly(), but the inverse inertia stays as it was: call refresh_inertia() before it is used.
/// Returns whether the body turned.
bool move_freely(BodyState& state, const BodyConstants& constants, double time);

/// As drift(), for a body that only its own velocity moves.
void drift_kinematic(BodyState& state, double time);

/// Angular momentum about the centre of mass in the world, with what split_gyroscopic() hid.
Vec3 momentum_of(const BodyState& state, const BodyConstants& constants);

/// Whether the inertia turns enough with the body in `time` (s) to matter: false for spheres and cubes, and for bodies
/// that turn by less than a thousandth of a radian.
bool has_gyroscopic_torque(const BodyState& state, const BodyConstants& constants, double time);

/// The world inverse inertia at the current rotation.
void refresh_inertia(BodyState& state, const BodyConstants& constants);

/// Rotation by the Cayley transform of `angle` (rad; 2 tan(θ/2) for the angle θ), as a unit quaternion.
Quat cayley(Vec3 angle);

}  // namespace embody::physics::dynamic
