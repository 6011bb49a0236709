// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "foundation/result.h"

// What deformables and fluids come to with finer meshes and shorter steps, beside theory.
namespace embody::convergence {

/// A measurement that is made at several resolutions.
struct Study {
    std::string_view name;
    std::string_view quantity;    ///< measured, with its unit
    std::string_view resolution;  ///< what is counted, more is finer
    std::string_view theory;      ///< the equation that `expected` follows from
    double expected;              ///< of the quantity
    std::span<const int> resolutions;
    Result<double> (*measure)(int resolution);  ///< the quantity at this resolution, > 0
};

/// Solids, sheets, ropes, liquids.
std::span<const Study> studies();
/// Null where there is none of that name.
const Study* find_study(std::string_view name);

}  // namespace embody::convergence
