// SPDX-License-Identifier: MIT
#include "physics/dynamic/mass.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/mass_properties.h"

namespace embody::physics::dynamic {

namespace {

bool is_multiple_of_identity(const Mat3& m) {
    const double mean = trace(m) / 3;
    const Mat3 rest = m - Mat3::identity() * mean;
    const double largest = std::max({length_squared(rest.x), length_squared(rest.y), length_squared(rest.z)});
    return largest <= 1e-20 * mean * mean;
}

}  // namespace

Result<void> resolve_mass(const MassDefinition& definition, const geometry::MassProperties& solid,
                          BodyConstants& constants) {
    const Result<BodyMass> body = body_mass(definition, solid);
    if (!body) return body.error();
    const Mat3 inverse = inverse_or_zero(body->inertia);
    if (!(determinant(body->inertia) > 0) || !is_finite(inverse.x) || !is_finite(inverse.y) || !is_finite(inverse.z)) {
        return Error{"mass.inertia", "of the shape is too small to be inverted"};
    }

    constants.mass = body->mass;
    constants.local_center = body->center;
    constants.inertia = body->inertia;
    constants.inverse_inertia = inverse;
    constants.is_isotropic = is_multiple_of_identity(body->inertia);
    return {};
}

}  // namespace embody::physics::dynamic
