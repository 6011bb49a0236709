// SPDX-License-Identifier: MIT
#include "physics/dynamic/mass.h"

#include <algorithm>
#include <cmath>

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
    const bool has_solid = solid.volume > 0;
    if (!definition.mass && !has_solid) return Error{"mass.mass", "must be given: the body has no shape with a volume"};
    const double mass = definition.mass ? *definition.mass : definition.density * solid.volume;
    if (!(mass >= 1e-9 && mass <= 1e12)) return Error{"mass.density", "gives a mass outside 1e-9 … 1e12 kg"};
    const Vec3 center = definition.center_of_mass ? *definition.center_of_mass : solid.center;

    // A homogeneous solid's inertia, scaled to the mass; about a given centre by the parallel axis theorem.
    Mat3 inertia;
    if (definition.inertia) {
        inertia = *definition.inertia;
    } else if (has_solid) {
        inertia = geometry::inertia_about(solid.inertia, solid.volume, center - solid.center) * (mass / solid.volume);
    } else {
        return Error{"mass.inertia", "must be given: the body has no shape with a volume"};
    }
    const Mat3 symmetric = (inertia + transpose(inertia)) * 0.5;
    const Mat3 inverse = inverse_or_zero(symmetric);
    if (!(determinant(symmetric) > 0) || !is_finite(inverse.x) || !is_finite(inverse.y) || !is_finite(inverse.z)) {
        return Error{"mass.inertia", "of the shape is too small to be inverted"};
    }

    constants.mass = mass;
    constants.local_center = center;
    constants.inertia = symmetric;
    constants.inverse_inertia = inverse;
    constants.is_isotropic = is_multiple_of_identity(symmetric);
    return {};
}

}  // namespace embody::physics::dynamic
