// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Shock propagation, which solver an island gets, sleep (src/physics/optimization).
struct OptimizationSettings {
    /// Number of levels of an island from which on shock propagation corrects the remaining penetration; for lower
    /// islands the contact solver's own correction is quick enough. Test: Settings.AreNoticed.
    std::uint32_t shock_min_levels = 4;
    /// Fraction of the penetration remaining after a step that shock propagation corrects in it; the method is of E.
    /// Guendelman et al., "Nonconvex rigid bodies with stacking", 2003. Source: all of it in one step throws up what
    /// lies on top.
    double shock_fraction = 0.2;
    /// Number of levels from which on an island counts as high: sweeps bring lower ones to rest. Test:
    /// Settings.AreNoticed.
    std::uint32_t direct_min_levels = 4;
    /// Cost up to which high islands are solved directly, in products of 6×6 blocks: chains and towers of few bodies a
    /// level. Above it sweeps are cheaper and hold the island as well. Bench: big_pyramid.
    std::uint32_t direct_max_products_high = 300;
    /// Mass of what lies above over the mass of what is below from which on sweeps converge too slowly. Test:
    /// Settings.AreNoticed.
    double direct_min_mass_ratio = 20;
    /// Cost up to which an island with heavy bodies on light ones is solved directly, in products of 6×6 blocks. Bench:
    /// heavy_on_light.
    std::uint32_t direct_max_products_heavy = 4000;
    /// Mass above a body of a tree over that body's mass from which on the tree is solved directly. Test:
    /// Settings.AreNoticed.
    double direct_min_load_ratio = 2;
    /// Fraction of the displacement that its sleep threshold allows within which a slow body is in balance. Test:
    /// Settings.AreNoticed.
    double sleep_travel_fraction = 1.0 / 60;
    /// Change of the force of wind, deformables or liquid on a sleeper since it fell asleep, over its weight, that
    /// wakes it. Test: Settings.AreNoticed.
    double wake_force_fraction = 0.05;
    /// Number of steps in which each sleeper is checked once for a change of the wind: four times a second at 60 Hz.
    /// Test: Settings.AreNoticed.
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
