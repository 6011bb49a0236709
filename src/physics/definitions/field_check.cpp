// SPDX-License-Identifier: MIT
#include "physics/definitions/field_check.h"

#include <cmath>
#include <cstdio>
#include <string>

namespace embody::physics {

namespace {

std::string in_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

bool is_zero_or_normal(double value) { return value == 0 || std::isnormal(value); }

}  // namespace

Result<void> check_number(std::string_view field, double value, double lowest, double highest, std::string_view unit) {
    const std::string suffix = (unit.empty() ? std::string() : std::string(" ")).append(unit);
    if (!std::isfinite(value)) return Error{std::string(field), "must be a finite number, got " + in_digits(value)};
    if (!is_zero_or_normal(value)) return Error{std::string(field), "is a denormal number; use 0"};
    if (value < lowest || value > highest) {
        return Error{std::string(field), "must be between " + in_digits(lowest) + " and " + in_digits(highest) +
                                             suffix + ", got " + in_digits(value)};
    }
    return {};
}

std::string field_item(std::string_view field, std::size_t index) {
    return std::string(field) + "[" + std::to_string(index) + "]";
}

Result<void> check_vector(std::string_view field, Vec3 value, double largest, std::string_view unit) {
    for (int i = 0; i < 3; ++i) {
        const std::string component = std::string(field) + "." + "xyz"[i];
        if (auto result = check_number(component, value[i], -largest, largest, unit); !result) return result;
    }
    return {};
}

Result<void> check_rotation(std::string_view field, Quat value) {
    // Denormal components of a rotation are harmless rounding, so only the rotation's length matters here.
    if (!is_finite(value)) return Error{std::string(field), "must be finite numbers"};
    const double squared = dot(value, value);
    if (!(squared > 1e-12) || !(squared < 1e12)) {
        return Error{std::string(field),
                     "must have a length between 1e-6 and 1e6, got " + in_digits(std::sqrt(squared))};
    }
    return {};
}

}  // namespace embody::physics
