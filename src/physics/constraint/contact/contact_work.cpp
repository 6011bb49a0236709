// SPDX-License-Identifier: MIT
//
// A solution of the contact laws obeys J·u <= 0 for every impulse J and the velocity u after it. Then T(v) <= T(v*), v*
// being the velocity without contacts: T(v*) − T(v) = ½ |v − v*|²_M − J·u. With v = v* + s Δ the difference is b s + c
// s², b = v*·M Δ, c = ½ Δ·M Δ >= 0.
#include "physics/constraint/contact/contact_work.h"

#include <algorithm>

namespace embody::physics::constraint {

ContactWork contact_work(const BodyConstants& constants, Quat rotation, const VelocityPair& free,
                         const VelocityPair& change) {
    const Vec3 turn = rotate_inverse(rotation, change.angular);
    const Vec3 momentum = constants.inertia * turn;
    return {constants.mass * dot(free.linear, change.linear) + dot(rotate_inverse(rotation, free.angular), momentum),
            (constants.mass * length_squared(change.linear) + dot(turn, momentum)) / 2};
}

double fraction_without_gain(const ContactWork& work) {
    if (work.linear + work.quadratic <= 0) return 1;
    return work.linear < 0 ? std::min(1.0, -work.linear / work.quadratic) : 0;
}

}  // namespace embody::physics::constraint
