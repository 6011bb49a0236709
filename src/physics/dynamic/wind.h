// SPDX-License-Identifier: MIT
#pragma once

#include "math/vec3.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/namespace.h"

namespace embody::physics::dynamic {

/// The air at one moment: its mean velocity, changed by smooth noise whose root mean square along the wind is
/// `gustiness` of its speed, across it and upwards 0.8 and 0.52 of that, as measured over flat land (H. A. Panofsky,
/// J. A. Dutton, "Atmospheric turbulence", 1984: 2.39, 1.92 and 1.25 friction velocities). Gusts are carried along by
/// the wind (G. I. Taylor, "The spectrum of turbulence", 1938) and are 0.3 times as wide and high as they are long.
/// Equal inputs give equal bits.
struct Wind {
    Vec3 mean;             ///< m/s
    double gustiness = 0;  ///< >= 0
    double gust_time = 2;  ///< how long a gust lasts, s, > 0
    double time = 0;       ///< s

    /// Whether the velocity changes with time and place.
    [[nodiscard]] bool is_gusty() const { return gustiness > 0 && length_squared(mean) > 0; }
    /// Velocity of the air at a place in the world, m/s.
    [[nodiscard]] Vec3 at(Vec3 position) const;
};

/// The air at a time of the world, s.
Wind wind_at(const WorldSettings& settings, double time);

}  // namespace embody::physics::dynamic
