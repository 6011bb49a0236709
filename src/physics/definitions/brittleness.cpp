// SPDX-License-Identifier: MIT
#include "physics/definitions/brittleness.h"

#include <cmath>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

Result<void> check_threshold(const char* field, double limit) {
    if (limit > 0) return {};
    return Error{field, "must be above 0, or infinite"};
}

}  // namespace

Result<void> validate(const Brittleness& brittleness) {
    const Brittleness& b = brittleness;
    if (auto result = first_error(check_threshold("break_impulse", b.break_impulse),
                                  check_threshold("break_energy", b.break_energy),
                                  check_number("fracture_energy", b.fracture_energy, 0.1, 1e6, "J/m²"),
                                  check_number("max_pieces", b.max_pieces, 2, 256));
        !result)
        return result;
    if (std::isinf(b.break_impulse) && std::isinf(b.break_energy))
        return Error{"break_impulse", "and break_energy are both infinite: nothing breaks it", "set one of them"};
    return {};
}

}  // namespace embody::physics
