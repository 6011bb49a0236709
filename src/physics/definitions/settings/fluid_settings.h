// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/fluid_cell_settings.h"
#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/definitions/settings/fluid_pressure_settings.h"
#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// When a fluid falls asleep (src/physics/stages/fluid/fluids.cpp). When it wakes a body that sleeps in it:
/// OptimizationSettings::wake_force_fraction.
struct FluidSleepSettings {
    /// Speed below which all particles but a few drops are quiet, m/s. Test: Settings.AreNoticed.
    double quiet_speed = 0.01;
    /// How long a fluid has to be quiet, s. Test: FluidContainer.WaterDroppedIntoATubComesToRestAndSleeps.
    double time_to_sleep = 1;
    /// Maximum speed at which the particles' centroid may sink meanwhile, cells a second: running honey is slower than
    /// the jitter of water at rest. Test: FluidSpill.HoneyThatStillRunsDoesNotSleep.
    double max_sinking_speed = 0.02;
};

template <>
inline constexpr auto settings_of<FluidSleepSettings> = std::tuple{
    Setting{"quiet_speed", &FluidSleepSettings::quiet_speed, 0, 1e3, "m/s"},
    Setting{"time_to_sleep", &FluidSleepSettings::time_to_sleep, 1e-5, 1e6, "s"},
    Setting{"max_sinking_speed", &FluidSleepSettings::max_sinking_speed, 0, 1e6, "cells/s"},
};
static_assert(setting_count<FluidSleepSettings> == member_count<FluidSleepSettings>(), "a setting is in no list");

/// Substeps that piles of grains need (substeps_for_grains in definitions/grain_material.h).
struct GrainSettings {
    /// Length of a substep over the time √(d/g) in which a grain falls its own diameter d: from 0.05 on piles come out
    /// steeper. Source: docs/physics/grains.md, "Steps". Test:
    /// GrainSteps.AreFinerForSmallerGrainsAndNeverCoarserThanAskedFor.
    double max_part = 0.047;
    /// Maximum substeps that a scene gets for its grains. Test: Settings.AreNoticed.
    int max_substeps = 16;
};

template <>
inline constexpr auto settings_of<GrainSettings> = std::tuple{
    Setting{"max_part", &GrainSettings::max_part, 1e-3, 10},
    Setting{"max_substeps", &GrainSettings::max_substeps, 1, 64},
};
static_assert(setting_count<GrainSettings> == member_count<GrainSettings>(), "a setting is in no list");

/// Liquids and grains (src/physics/fluid, stages/fluid).
struct FluidSettings {
    FluidPartSettings parts;
    FluidCellSettings cells;
    FluidPressureSettings pressure;
    FluidVolumeSettings volume;
    FluidViscositySettings viscosity;
    FluidTensionSettings tension;
    FluidObstacleSettings obstacles;
    FluidCollisionSettings collision;
    FluidDropSettings drops;
    FluidComponentSettings components;
    FluidSleepSettings sleep;
    GrainSettings grains;
};

template <>
inline constexpr auto settings_of<FluidSettings> = std::tuple{
    Setting{"parts", &FluidSettings::parts},         Setting{"cells", &FluidSettings::cells},
    Setting{"pressure", &FluidSettings::pressure},   Setting{"volume", &FluidSettings::volume},
    Setting{"viscosity", &FluidSettings::viscosity}, Setting{"tension", &FluidSettings::tension},
    Setting{"obstacles", &FluidSettings::obstacles}, Setting{"collision", &FluidSettings::collision},
    Setting{"drops", &FluidSettings::drops},         Setting{"components", &FluidSettings::components},
    Setting{"sleep", &FluidSettings::sleep},         Setting{"grains", &FluidSettings::grains},
};
static_assert(setting_count<FluidSettings> == member_count<FluidSettings>(), "a group is in no list");

}  // namespace embody::physics
