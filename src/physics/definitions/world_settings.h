// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"
#include "math/vec3.h"
#include "physics/definitions/settings/solver_settings.h"

namespace embody::physics {

struct WorldSettings {
    Vec3 gravity{0, -9.81, 0};    ///< m/s²
    double time_step = 1.0 / 60;  ///< s, 1e-5 … 0.1
    int substeps = 4;             ///< parts a step is solved in, 1 … 64
    Vec3 wind;                    ///< velocity of the air, m/s
    double gustiness = 0;         ///< root mean square of the wind's changes over its speed, 0 … 2
    double gust_time = 2;         ///< how long a gust lasts, s, 0.05 … 1000
    double air_density = 1.2;     ///< kg/m³, 0 … 100
    int deformable_substeps = 2;  ///< the same for deformables, after the bodies, 1 … 64
    double time_to_sleep = 0.5;   ///< an island this long quiet falls asleep, s, 0.05 … 60
    bool sleeping = true;
    bool shock_propagation = true;   ///< paper, section IV
    double max_linear_speed = 1e4;   ///< a faster body is slowed to this and the report says so, m/s
    double max_angular_speed = 2e4;  ///< the same for turning, rad/s
    /// Threads that a step may use, 1 … 64; 0: as many as pay on this machine (TaskPool), fewer while other programs
    /// need its cores; small worlds use one whatever is set. Same result.
    int workers = 1;
    int lanes = 0;  ///< contacts solved by one instruction: 4, 8 or 16; 0: as many as the processor can. Same result.
    SolverSettings solver;  ///< the numbers that steer the algorithms
};

/// The error's `where` is the field.
Result<void> validate(const WorldSettings& settings);

}  // namespace embody::physics
