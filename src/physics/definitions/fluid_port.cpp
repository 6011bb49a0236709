// SPDX-License-Identifier: MIT
#include "physics/definitions/fluid_port.h"

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

constexpr double largest_radius = 10;  // m

Result<void> validate(const FluidSource& source) {
    if (source.fluid.is_null()) return Error{"fluid", "is none", "name the fluid that gains what comes out"};
    if (Result<void> direction = check_vector("direction", source.direction, largest_coordinate); !direction)
        return direction;
    if (source.direction == Vec3{}) return Error{"direction", "is zero", "say where the liquid flows to"};
    if (source.radius == 0 && source.speed == 0)
        return Error{"speed", "follows from no radius", "set the radius of the opening, or the speed"};
    return first_error(check_vector("position", source.position, largest_coordinate, "m"),
                       check_number("radius", source.radius, 0, largest_radius, "m"),
                       check_number("rate", source.rate, 0, 10, "m³/s"),
                       check_number("speed", source.speed, 0, 100, "m/s"));
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
