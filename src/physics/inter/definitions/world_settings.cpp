// SPDX-License-Identifier: MIT
#include "physics/inter/definitions/world_settings.h"

#include "physics/inter/definitions/field_check.h"

namespace embody::physics {

Result<void> validate(const WorldSettings& settings) {
    return first_error(check_vector("gravity", settings.gravity, 1e4, "m/s²"),
                       check_number("time_step", settings.time_step, 1e-5, 0.1, "s"),
                       check_number("substeps", settings.substeps, 1, 64),
                       check_number("time_to_sleep", settings.time_to_sleep, 0.05, 60, "s"),
                       check_number("max_linear_speed", settings.max_linear_speed, 1, largest_linear_speed, "m/s"));
}

}  // namespace embody::physics
