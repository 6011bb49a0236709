// SPDX-License-Identifier: MIT
#include "physics/definitions/fluid_definition.h"

#include <string>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

Result<void> check_boxes(const FluidDefinition& definition) {
    for (std::size_t i = 0; i < definition.boxes.size(); ++i) {
        const Bounds& box = definition.boxes[i];
        const std::string name = field_item("boxes", i);
        if (auto result = first_error(check_vector(name + ".lower", box.lower, largest_coordinate, "m"),
                                      check_vector(name + ".upper", box.upper, largest_coordinate, "m"));
            !result)
            return result;
        if (!(box.lower.x < box.upper.x) || !(box.lower.y < box.upper.y) || !(box.lower.z < box.upper.z))
            return Error{name, "is empty", "give each upper coordinate above the lower one"};
    }
    return {};
}

Result<void> check_points(const std::string& name, const std::vector<Vec3>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (auto result = check_vector(name + "[" + std::to_string(i) + "]", points[i], largest_coordinate, "m");
            !result)
            return result;
    }
    return {};
}

}  // namespace

Result<void> validate(const LiquidMatter& matter) {
    return first_error(check_number("density", matter.density, 1, 25'000, "kg/m³"),
                       check_number("viscosity", matter.viscosity, 0, 10'000, "Pa s"),
                       check_number("yield_stress", matter.yield_stress, 0, 10'000, "Pa"),
                       check_number("surface_tension", matter.surface_tension, 0, 10, "N/m"));
}

Result<void> validate(const FluidDefinition& definition) {
    const FluidDefinition& d = definition;
    if (d.boxes.empty() && d.hulls.empty() && d.points.empty())
        return Error{"boxes", "are none", "give at least one box, hull or point that the liquid fills at the start"};
    if (auto result = check_boxes(d); !result) return result;
    for (std::size_t i = 0; i < d.hulls.size(); ++i) {
        if (auto result = check_points(field_item("hulls", i), d.hulls[i]); !result) return result;
    }
    if (auto result = check_points("points", d.points); !result) return result;
    return first_error(check_vector("velocity", d.velocity, largest_linear_speed, "m/s"),
                       validate(LiquidMatter{d.density, d.viscosity, d.yield_stress, d.surface_tension}),
                       check_number("cell_size", d.cell_size, 0.001, 1, "m"),
                       check_number("gravity_factor", d.gravity_factor, -10, 10));
}

}  // namespace embody::physics
