// SPDX-License-Identifier: MIT
#include "physics/definitions/fluid_port.h"

#include <numbers>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

constexpr double largest_radius = 10;  // m
constexpr double fastest = 100;        // m/s

Result<void> validate(const FluidSource& source) {
    if (source.fluid.is_null()) return Error{"fluid", "is none", "name the fluid that gains what comes out"};
    if (Result<void> direction = check_vector("direction", source.direction, largest_coordinate); !direction)
        return direction;
    if (normalized(source.direction) == Vec3{}) return Error{"direction", "is zero", "say where the liquid flows to"};
    if (source.radius == 0 && source.speed == 0)
        return Error{"speed", "follows from no radius", "set the radius of the opening, or the speed"};
    if (source.ids.first > source.ids.last) return Error{"ids", "end before they begin"};
    if (source.matter) {
        if (Result<void> valid = physics::validate(*source.matter); !valid)
            return Error{"matter." + valid.error().where, valid.error().why, valid.error().remedy};
    }
    if (source.max_particles > max_fluid_particles)
        return Error{"max_particles", "is more than a fluid has", "at most " + std::to_string(max_fluid_particles)};
    if (auto numbers = first_error(check_vector("position", source.position, largest_coordinate, "m"),
                                   check_number("radius", source.radius, 0, largest_radius, "m"),
                                   check_number("rate", source.rate, 0, 10, "m³/s"),
                                   check_number("speed", source.speed, 0, fastest, "m/s"));
        !numbers)
        return numbers;
    const double filling = source.rate / (std::numbers::pi * source.radius * source.radius);
    if (source.speed == 0 && source.rate > 0 && !(filling <= fastest))
        return Error{"radius", "is so small that the rate leaves at more than 100 m/s", "enlarge it, or set the speed"};
    return {};
}

Result<void> validate(const FluidDrain& drain) {
    return first_error(check_vector("position", drain.position, largest_coordinate, "m"),
                       check_number("radius", drain.radius, 0, largest_radius, "m"));
}

}  // namespace

Result<void> validate(const FluidPort& port) {
    return std::visit([](const auto& of_kind) { return validate(of_kind); }, port);
}

}  // namespace embody::physics
