// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/deformable_settings.h"
#include "physics/definitions/surface_pairs.h"
#include "physics/deformable/namespace.h"
#include "physics/dynamic/wind.h"

namespace embody::physics::deformable {

/// Input of a deformable for one substep.
struct Substep {
    double h = 1.0 / 60;                                    ///< its length, s
    double time = 0;                                        ///< of its start, s after the step began
    Vec3 gravity;                                           ///< m/s², with the deformable's own gravity factor
    Wind wind;                                              ///< of the air
    double air_density = 1.2;                               ///< kg/m³
    const SurfacePairs* surface_pairs = &no_surface_pairs;  ///< of the world
    DeformableSettings settings = {};                       ///< of the world
};

}  // namespace embody::physics::deformable
