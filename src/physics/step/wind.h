// SPDX-License-Identifier: MIT
#pragma once

#include "physics/inter/definitions/world_settings.h"

namespace embody::physics {

/// Velocity of the air at a time (s since the world was made), m/s: the same everywhere. The wind of the settings on
/// average, changed by smooth noise whose root mean square along the wind is `gustiness` of its speed, across it and
/// upwards 0.8 and 0.52 of that, as measured over flat land (H. A. Panofsky, J. A. Dutton, "Atmospheric turbulence",
/// 1984: 2.39, 1.92 and 1.25 friction velocities). Same settings and time, same bits.
Vec3 wind_at(const WorldSettings& settings, double time);

/// Whether the wind changes with time.
bool is_gusty(const WorldSettings& settings);

}  // namespace embody::physics
