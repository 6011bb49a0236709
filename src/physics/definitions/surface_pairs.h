// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "foundation/result.h"

namespace embody::physics {

/// A kind of surface, such as "steel"; numbered by whoever makes the table. 0: none in particular.
using SurfaceId = std::uint8_t;

/// How two surfaces behave against each other.
struct PairCoefficients {
    double friction_static = 0.5;   ///< 0 … 2, >= friction_dynamic
    double friction_dynamic = 0.5;  ///< 0 … 2
    double restitution = 0;         ///< 0 … 1
};

/// Friction and restitution are properties of a pair, not of a body: measured values by pair of surfaces.
class SurfacePairs {
public:
    /// For a against b and b against a. Refuses numbers out of range and surface 0.
    Result<void> set(SurfaceId a, SurfaceId b, const PairCoefficients& coefficients);
    /// Null where the pair is not in the table.
    [[nodiscard]] const PairCoefficients* find(SurfaceId a, SurfaceId b) const;

private:
    std::vector<std::optional<PairCoefficients>> rows_;  ///< lower triangle of the symmetric table
};

inline const SurfacePairs no_surface_pairs;

}  // namespace embody::physics
