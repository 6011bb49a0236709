// SPDX-License-Identifier: MIT
#include "physics/definitions/body_definition.h"

#include <cmath>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

// Symmetric, positive definite, and no principal moment above the sum of the others: else no matter could have it.
Result<void> check_inertia(const Mat3& inertia) {
    const char* field = "mass.inertia";
    for (int c = 0; c < 3; ++c) {
        if (auto result = check_vector(field, inertia.column(c), 1e15, "kg m²"); !result) return result;
    }
    const double size = trace(inertia);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < r; ++c) {
            if (std::fabs(inertia(r, c) - inertia(c, r)) > 1e-6 * std::fabs(size)) {
                return Error{field, "must be symmetric"};
            }
        }
    }
    const Vec3 moments = eigen_symmetric(inertia).values;
    if (!(moments.x > 1e-18)) return Error{field, "must be positive definite, each moment above 1e-18 kg m²"};
    if (moments.z > (moments.x + moments.y) * (1 + 1e-6)) {
        return Error{field, "each principal moment must not exceed the sum of the other two"};
    }
    return {};
}

Result<void> check_mass(const MassDefinition& mass) {
    if (auto result = check_number("mass.density", mass.density, 1e-3, 1e6, "kg/m³"); !result) return result;
    if (mass.mass) {
        if (auto result = check_number("mass.mass", *mass.mass, 1e-6, 1e9, "kg"); !result) return result;
    }
    if (mass.center_of_mass) {
        if (auto result = check_vector("mass.center_of_mass", *mass.center_of_mass, 1e5, "m"); !result) return result;
    }
    return mass.inertia ? check_inertia(*mass.inertia) : Result<void>{};
}

}  // namespace

Result<void> validate(const BodyDefinition& definition) {
    const BodyDefinition& d = definition;
    if (d.kind > BodyKind::dynamic_body) return Error{"kind", "is not a kind of body"};
    if (auto result = validate(d.material); !result) {
        return Error{"material." + result.error().where, result.error().why, result.error().remedy};
    }
    if (d.brittleness) {
        if (auto result = validate(*d.brittleness); !result)
            return Error{"brittleness." + result.error().where, result.error().why, result.error().remedy};
    }
    return first_error(
        check_vector("position", d.position, largest_coordinate, "m"), check_rotation("rotation", d.rotation),
        check_vector("linear_velocity", d.linear_velocity, largest_linear_speed, "m/s"),
        check_vector("angular_velocity", d.angular_velocity, largest_angular_speed, "rad/s"), check_mass(d.mass),
        check_number("linear_damping", d.linear_damping, 0, 100, "1/s"),
        check_number("drag_area", d.drag_area, 0, 1e8, "m²"),
        check_number("angular_damping", d.angular_damping, 0, 100, "1/s"),
        check_number("gravity_factor", d.gravity_factor, -10, 10), check_vector("force", d.force, largest_force, "N"),
        check_vector("torque", d.torque, largest_force, "N m"),
        check_number("sleep_energy_per_mass", d.sleep_energy_per_mass, 0, 1, "J/kg"));
}

}  // namespace embody::physics
