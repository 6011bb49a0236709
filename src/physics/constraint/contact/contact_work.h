// SPDX-License-Identifier: MIT
#pragma once

#include "physics/constraint/namespace.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// What contacts did to the kinetic energy of bodies, J, had they done the share s of it: linear · s + quadratic · s².
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

/// The largest share of what contacts did that gives no energy: contacts at rest and in sliding only take some (paper,
/// eq. 4 and 7), and what sweeps that have not converged give is error. All impulses take the same share, so momentum
/// is kept.
double fraction_without_gain(const ContactWork& work);

}  // namespace embody::physics::constraint
