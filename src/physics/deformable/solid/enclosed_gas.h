// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/definitions/settings/solid_settings.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Gas inside a closed surface, of uniform pressure and constant temperature (Boyle's law). At rest its pressure and
/// the tension of what encloses it are in balance: the rest shape is the inflated one.
class EnclosedGas {
public:
    /// `surface` is counter-clockwise from outside; `pressure` above that of the air around, Pa, > 0.
    EnclosedGas(double pressure, std::span<const std::array<std::uint32_t, 3>> surface, std::span<const Vec3> rest);

    /// Finds volume and slope with the nodes at these places, m. `min_fraction`: SolidSettings::min_gas_fraction.
    void measure(std::span<const std::array<std::uint32_t, 3>> surface, std::span<const Vec3> position,
                 double min_fraction = SolidSettings{}.min_gas_fraction);

    /// ∂V/∂x of each node, m², of the last measure().
    [[nodiscard]] const std::vector<Vec3>& slope() const { return slope_; }
    /// Pressure beyond that at rest, Pa.
    [[nodiscard]] double excess() const { return absolute_ * (rest_volume_ / volume_ - 1); }
    /// -∂p/∂V, Pa/m³.
    [[nodiscard]] double stiffness() const { return absolute_ * rest_volume_ / (volume_ * volume_); }
    /// Work to bring it from rest to a volume, including that of the air around and of the tension at rest, J.
    [[nodiscard]] double energy() const;

private:
    double absolute_ = 0;     ///< of the gas at rest, Pa
    double rest_volume_ = 0;  ///< m³
    double volume_ = 0;
    std::vector<Vec3> slope_;
};

}  // namespace embody::physics::deformable
