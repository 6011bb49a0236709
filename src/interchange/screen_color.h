// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace embody::interchange {

/// Clamps to 0 … 1; 0 for NaN.
inline float unit_range(float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f; }

/// The colours of formats older than glTF are meant for the screen (IEC 61966-2-1).
inline float linear_from_srgb(float value) {
    value = unit_range(value);
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

/// Blinn-Phong exponent n to GGX's α = roughness²: α² = 2 / (n + 2). Kept off the mirror end: old exponents are
/// guesses.
inline float roughness_from_exponent(float exponent) {
    return std::clamp(std::pow(2.0f / (exponent + 2.0f), 0.25f), 0.35f, 1.0f);
}

}  // namespace embody::interchange
