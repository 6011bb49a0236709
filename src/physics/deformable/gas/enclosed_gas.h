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

/// Gas inside a closed surface, of uniform pressure and constant temperature (Boyle's law). The rest shape of a solid
/// is the inflated one: there its pressure and the tension of what encloses it are in balance, and excess() and
/// energy() are beyond these. A sheet has no tension at rest: gauge() and gauge_energy() are all that acts on it.
class EnclosedGas {
public:
    /// `surface` is counter-clockwise from outside; `pressure` of the rest shape above that of the air around, Pa, > 0.
    EnclosedGas(double pressure, std::span<const std::array<std::uint32_t, 3>> surface, std::span<const Vec3> rest);

    /// Finds volume and slope with the nodes at these places, m. `min_fraction`: SolidSettings::min_gas_fraction.
    void measure(std::span<const std::array<std::uint32_t, 3>> surface, std::span<const Vec3> position,
                 double min_fraction = SolidSettings{}.min_gas_fraction);

    /// ∂V/∂x of each node, m², of the last measure().
    [[nodiscard]] const std::vector<Vec3>& slope() const { return slope_; }
    /// Pressure beyond that at rest, Pa.
    [[nodiscard]] double excess() const { return absolute_ * (rest_volume_ / volume_ - 1); }
    /// Pressure above that of the air around, Pa; below 0 where there is less gas than fills the volume.
    [[nodiscard]] double gauge() const { return pressure_ + excess(); }
    /// m³.
    [[nodiscard]] double volume() const { return volume_; }
    /// -∂p/∂V, Pa/m³.
    [[nodiscard]] double stiffness() const { return absolute_ * rest_volume_ / (volume_ * volume_); }
    /// Work to bring it from rest to a volume, including that of the air around and of the tension at rest, J.
    [[nodiscard]] double energy() const;
    /// The same without the tension: the work against gauge(), J.
    [[nodiscard]] double gauge_energy() const { return energy() - pressure_ * (volume_ - rest_volume_); }

private:
    double pressure_ = 0;     ///< at rest above that of the air, Pa
    double absolute_ = 0;     ///< of the gas at rest, Pa
    double rest_volume_ = 0;  ///< m³
    double volume_ = 0;
    std::vector<Vec3> slope_;
};

}  // namespace embody::physics::deformable
