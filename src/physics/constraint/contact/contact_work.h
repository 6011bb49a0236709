// SPDX-License-Identifier: MIT
#pragma once

#include "physics/constraint/namespace.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// What contacts did to the kinetic energy of bodies, J, had they done the fraction s of it: linear · s + quadratic ·
/// s².
struct ContactWork {
    double linear = 0, quadratic = 0;
    ContactWork& operator+=(const ContactWork& other) {
        linear += other.linear;
        quadratic += other.quadratic;
        return *this;
    }
};

/// Of one body: `free` is the velocity that it would have without contacts, `change` what they added to it.
struct VelocityPair {
    Vec3 linear, angular;  ///< m/s, rad/s, world
};
ContactWork contact_work(const BodyConstants& constants, Quat rotation, const VelocityPair& free,
                         const VelocityPair& change);

/// The largest fraction of what contacts did that adds no energy: sticking and sliding contacts only take energy
/// (paper, eq. 4 and 7), and energy that unconverged sweeps add is error. All impulses are scaled by the same fraction,
/// so momentum is kept.
double fraction_without_gain(const ContactWork& work);

}  // namespace embody::physics::constraint
