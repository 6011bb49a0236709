// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Shock propagation, which solver an island gets, sleep (src/physics/optimization).
struct OptimizationSettings {
    /// Levels of an island from which on shock propagation takes out what is left of penetration; in lower ones the
    /// contact solver's own correction is quick enough. Test: ShockPropagation.LeavesWhatIsNotDeepWhereItIs.
    std::uint32_t shock_min_levels = 4;
    /// Share of the penetration left after a step that shock propagation takes out in it. Source: Guendelman et al.
    /// 2003 take out all of it in one sweep, which here throws up what lies on top.
    double shock_fraction = 0.2;
    /// Levels from which on an island counts as high: sweeps of lower ones come to rest by themselves. Test:
    /// DirectIslands.AreTallOnesAndHeavyOnesOnLight.
    std::uint32_t direct_min_levels = 4;
    /// Cost up to which high islands are solved directly, in products of 6×6 blocks: chains and towers of few bodies a
    /// level. Above, sweeps are cheaper and stand as well. Bench: big_pyramid.
    std::uint32_t direct_max_products_high = 300;
    /// Mass of what lies above over the mass of what is below from which on sweeps converge too slowly. Test:
    /// DirectIslands.AreTallOnesAndHeavyOnesOnLight.
    double direct_min_mass_ratio = 20;
    /// Cost up to which heavy on light is solved directly, in products of 6×6 blocks. Bench: heavy_on_light.
    std::uint32_t direct_max_products_heavy = 4000;
    /// All the mass above a body of a tree over that body's from which on the tree is solved directly. Test:
    /// DirectIslands.AreTallOnesAndHeavyOnesOnLight.
    double direct_min_load_ratio = 2;
    /// Share of the way that its sleep threshold allows within which a slow body is in balance. Test:
    /// SleepOnlyInBalance.ABallRollsDownTheGentlestSlope.
    double sleep_travel_fraction = 1.0 / 60;
    /// Share of its weight by which the force of wind, of what bends or of a liquid on a sleeper must differ from when
    /// it fell asleep to wake it. Test: Settings.AreNoticed.
    double wake_force_fraction = 0.05;
    /// Steps in which each sleeper is asked once whether the wind has changed: four times a second at 60 Hz. Test:
    /// Settings.AreNoticed.
    std::uint32_t wake_wind_steps = 15;
    /// Gap up to which sleepers around a body that users add, change or take away wake, m. Test: Settings.AreNoticed.
    double wake_reach = 0.01;
};

template <>
inline constexpr auto settings_of<OptimizationSettings> = std::tuple{
    Setting{"shock_min_levels", &OptimizationSettings::shock_min_levels, 1, 1000},
    Setting{"shock_fraction", &OptimizationSettings::shock_fraction, 0.01, 1},
    Setting{"direct_min_levels", &OptimizationSettings::direct_min_levels, 1, 1000},
    Setting{"direct_max_products_high", &OptimizationSettings::direct_max_products_high, 0, 1e9},
    Setting{"direct_min_mass_ratio", &OptimizationSettings::direct_min_mass_ratio, 1, 1e9},
    Setting{"direct_max_products_heavy", &OptimizationSettings::direct_max_products_heavy, 0, 1e9},
    Setting{"direct_min_load_ratio", &OptimizationSettings::direct_min_load_ratio, 0, 1e9},
    Setting{"sleep_travel_fraction", &OptimizationSettings::sleep_travel_fraction, 1e-4, 10},
    Setting{"wake_force_fraction", &OptimizationSettings::wake_force_fraction, 0, 1e3},
    Setting{"wake_wind_steps", &OptimizationSettings::wake_wind_steps, 1, 1e6},
    Setting{"wake_reach", &OptimizationSettings::wake_reach, 0, 1e3, "m"},
};
static_assert(setting_count<OptimizationSettings> == member_count<OptimizationSettings>(), "a setting is in no list");

}  // namespace embody::physics
