// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

namespace embody::attributes {

/// The valid range of a number; open where infinite.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    const char* unit = "";  ///< of the number, for messages and descriptions
};
inline constexpr NumberRange any_number{};
inline constexpr NumberRange not_negative{.low = 0};
inline constexpr NumberRange positive{.low = std::numeric_limits<double>::min()};

}  // namespace embody::attributes
