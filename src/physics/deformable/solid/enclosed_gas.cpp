// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/enclosed_gas.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/deformable_definition.h"

namespace embody::physics::deformable {

EnclosedGas::EnclosedGas(double pressure, std::span<const std::array<std::uint32_t, 3>> surface,
                         std::span<const Vec3> rest)
    : absolute_(pressure + air_pressure) {
    measure(surface, rest);
    rest_volume_ = volume_;
}

// V = Σ a·(b × c)/6 over the faces, from a place among them to avoid cancellation.
void EnclosedGas::measure(std::span<const std::array<std::uint32_t, 3>> surface, std::span<const Vec3> position,
                          double min_fraction) {
    slope_.assign(position.size(), {});
    const Vec3 origin = position[surface.front()[0]];
    volume_ = 0;
    for (const auto& face : surface) {
        const Vec3 a = position[face[0]] - origin, b = position[face[1]] - origin, c = position[face[2]] - origin;
        const Vec3 bc = cross(b, c) / 6, ca = cross(c, a) / 6, ab = cross(a, b) / 6;
        volume_ += dot(a, bc);
        slope_[face[0]] += bc;
        slope_[face[1]] += ca;
        slope_[face[2]] += ab;
    }
    volume_ = std::max(volume_, min_fraction * rest_volume_);
}

// ∫ p₀ (1 - V₀/V) dV
double EnclosedGas::energy() const {
    return absolute_ * (volume_ - rest_volume_ - rest_volume_ * std::log(volume_ / rest_volume_));
}

}  // namespace embody::physics::deformable
