// SPDX-License-Identifier: MIT
#include "physics/definitions/world_settings.h"

#include <string>

#include "physics/definitions/field_check.h"

namespace embody::physics {

static Result<void> check_lanes(int lanes) {
    if (lanes == 0 || lanes == 4 || lanes == 8 || lanes == 16) return {};
    return Error{"lanes", "is " + std::to_string(lanes), "set 4, 8, 16, or 0 for as many as the processor can"};
}

Result<void> validate(const WorldSettings& settings) {
    return first_error(
        check_vector("gravity", settings.gravity, 1e4, "m/s²"),
        check_number("time_step", settings.time_step, 1e-5, 0.1, "s"),
        check_number("substeps", settings.substeps, 1, 64), check_vector("wind", settings.wind, 1000, "m/s"),
        check_number("gustiness", settings.gustiness, 0, 2),
        check_number("gust_time", settings.gust_time, 0.05, 1000, "s"),
        check_number("air_density", settings.air_density, 0, 100, "kg/m³"),
        check_number("deformable_substeps", settings.deformable_substeps, 1, 64),
        check_number("time_to_sleep", settings.time_to_sleep, 0.05, 60, "s"),
        check_number("max_linear_speed", settings.max_linear_speed, 1, largest_linear_speed, "m/s"),
        check_number("max_angular_speed", settings.max_angular_speed, 1, largest_angular_speed, "rad/s"),
        check_number("workers", settings.workers, 0, 64), check_lanes(settings.lanes), validate(settings.solver));
}

}  // namespace embody::physics
