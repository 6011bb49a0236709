// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/definitions/settings/ball_settings.h"
#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Bodies of revolution that roll on something flat (src/physics/constraint/rolling/rolling_body.cpp).
struct RollingBodySettings {
    /// Maximum gap of the higher end of a line that touches along its length, m. Test: Settings.AreNoticed.
    double side_gap = 5e-5;
    /// Maximum slip that is stopped at the start of a step, over the speed of the farthest point by turning. Test:
    /// Settings.AreNoticed.
    double max_slip_fraction = 0.05;
    /// Maximum slip that is stopped besides, m/s. Test: Settings.AreNoticed.
    double max_slip_speed = 0.01;
    /// Sine of the angle between axis and normal below which the rim lies flat on the ground. Test:
    /// Settings.AreNoticed.
    double min_lean = 0.005;
    /// Turn of the axis in a step below which the contact solver loses no energy, rad. Test: Settings.AreNoticed.
    double min_axis_turn = 1e-3;
    /// Turn of the body in a step above which the contact solver's approximation of small turns fails, rad. Test:
    /// Settings.AreNoticed.
    double min_turn = 0.5;
    /// Maximum turn in a part of the step, rad. Test: Settings.AreNoticed.
    double part_turn = 0.08;
    /// Maximum number of parts of a step; the contact solver takes what needs more. Test:
    /// Rolling.EveryRoundShapeKeepsItsSpeedOnEveryGround.
    int max_parts = 400;
    /// Maximum relative error of the energy that Runge-Kutta makes in a step; it is corrected. Test:
    /// Settings.AreNoticed.
    double max_energy_error = 1e-3;
    /// Maximum number of contacts of a rolling body: a body that rolls on still faces has two rims on two neighbouring
    /// triangles. Test: Rolling.EveryRoundShapeKeepsItsSpeedOnEveryGround.
    std::uint32_t max_contacts = 8;
};

template <>
inline constexpr auto settings_of<RollingBodySettings> = std::tuple{
    Setting{"side_gap", &RollingBodySettings::side_gap, 0, 0.01, "m"},
    Setting{"max_slip_fraction", &RollingBodySettings::max_slip_fraction, 0, 1},
    Setting{"max_slip_speed", &RollingBodySettings::max_slip_speed, 0, 10, "m/s"},
    Setting{"min_lean", &RollingBodySettings::min_lean, 1e-6, 1},
    Setting{"min_axis_turn", &RollingBodySettings::min_axis_turn, 0, 10, "rad"},
    Setting{"min_turn", &RollingBodySettings::min_turn, 0, 10, "rad"},
    Setting{"part_turn", &RollingBodySettings::part_turn, 1e-3, 1, "rad"},
    Setting{"max_parts", &RollingBodySettings::max_parts, 1, 1e5},
    Setting{"max_energy_error", &RollingBodySettings::max_energy_error, 0, 1},
    Setting{"max_contacts", &RollingBodySettings::max_contacts, 1, 1e6},
};
static_assert(setting_count<RollingBodySettings> == member_count<RollingBodySettings>(), "a setting is in no list");

/// Bodies that are moved along the ground by their own equations (src/physics/constraint/rolling).
struct RollingSettings {
    /// Gap beyond which a ball or a ring does not touch the ground, m. Test: Settings.AreNoticed.
    double touch_gap = 2e-4;
    /// Speed towards the ground above which a body that did not touch it has an impact, m/s. Test:
    /// Settings.AreNoticed.
    double max_approach_speed = 0.05;
    /// Separating speed above which a ball leaves the ground, m/s. Test: Settings.AreNoticed.
    double max_parting_speed = 1e-3;
    BallPathSettings ball;
    BallClusterSettings cluster;
    RollingBodySettings body;
};

template <>
inline constexpr auto settings_of<RollingSettings> = std::tuple{
    Setting{"touch_gap", &RollingSettings::touch_gap, 1e-9, 0.1, "m"},
    Setting{"max_approach_speed", &RollingSettings::max_approach_speed, 0, 10, "m/s"},
    Setting{"max_parting_speed", &RollingSettings::max_parting_speed, 0, 10, "m/s"},
    Setting{"ball", &RollingSettings::ball},
    Setting{"cluster", &RollingSettings::cluster},
    Setting{"body", &RollingSettings::body},
};
static_assert(setting_count<RollingSettings> == member_count<RollingSettings>(), "a setting is in no list");

}  // namespace embody::physics
