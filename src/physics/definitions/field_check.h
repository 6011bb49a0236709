// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "foundation/result.h"
#include "math/transform.h"

namespace embody::physics {

// Every number that enters the physics passes one of these; the error names the field. A number is good if it is
// finite, not denormal and within its range. Denormals are refused because they only come from mistakes, lose digits
// and slow the machine down.

Result<void> check_number(std::string_view field, double value, double lowest, double highest,
                          std::string_view unit = "");
/// Each component within ±`largest`.
Result<void> check_vector(std::string_view field, Vec3 value, double largest, std::string_view unit = "");
/// Finite and long enough to be normalised.
Result<void> check_rotation(std::string_view field, Quat value);

/// The name of one item of a list: `boxes[3]`.
std::string field_item(std::string_view field, std::size_t index);

/// Bounds that keep every product of the solver far from overflow.
inline constexpr double largest_coordinate = 1e9;     ///< m
inline constexpr double largest_linear_speed = 1e6;   ///< m/s
inline constexpr double largest_angular_speed = 1e5;  ///< rad/s
inline constexpr double largest_force = 1e15;         ///< N, N m, N s

/// The first error of several checks.
template <class... Checks>
Result<void> first_error(Checks... checks) {
    Result<void> result;
    ((result.ok() && !checks.ok() ? void(result = checks) : void()), ...);
    return result;
}

}  // namespace embody::physics
