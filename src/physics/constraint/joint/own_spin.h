// SPDX-License-Identifier: MIT
#pragma once

#include "physics/constraint/namespace.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// The spin of a body about its own axis of symmetry where every joint holds it on that axis and leaves it free about
/// it: it changes nothing that the joints see, so they are solved for the rest of the motion, with the spin's angular
/// momentum carried along by the axis (a gyrostat: a rotor in a carrier that does not spin). The spin is conserved,
/// however fast it is.
struct OwnSpin {
    double rate = 0;  ///< rad/s about the axis
    Vec3 momentum;    ///< world, when the substep began, kg m²/s
    Quat turn;        ///< over the substep, body axes
};

/// The unit vector along `direction` (body axes, any length) if that is an axis of symmetry of the body's inertia; else
/// zero, as for a zero `direction`.
Vec3 symmetry_axis_along(Vec3 direction, const BodyConstants& constants);

/// Whether a point (from the centre of mass, m) lies on the axis, but for rounding.
bool is_on_axis(Vec3 point, Vec3 axis);

/// The body's spin about the axis and its turn in `time`, s; no spin where the axis is zero.
OwnSpin own_spin_of(const BodyState& state, const BodyConstants& constants, Vec3 axis, double time);

}  // namespace embody::physics::constraint
