// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "foundation/result.h"

// Errors of deformables and fluids against theory, with finer meshes and shorter steps.
namespace embody::convergence {

/// A measurement that is repeated at several resolutions.
struct Study {
    std::string_view name;
    std::string_view quantity;    ///< what is measured, with its unit
    std::string_view resolution;  ///< what is counted; more is finer
    std::string_view theory;      ///< the equation that `expected` follows from
    double expected;              ///< value of the quantity by theory
    std::span<const int> resolutions;
    Result<double> (*measure)(int resolution);  ///< returns the quantity at this resolution, > 0
};

/// Solids, sheets, ropes, liquids.
std::span<const Study> studies();
/// Null for an unknown name.
const Study* find_study(std::string_view name);

}  // namespace embody::convergence
