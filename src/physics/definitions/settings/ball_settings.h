// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// A ball along still ground (src/physics/constraint/rolling/ball_path.cpp).
struct BallPathSettings {
    /// Maximum turn of the normal, or of the phase of an oscillation, in a part of the step, rad. Test:
    /// Settings.AreNoticed.
    double part_turn = 0.06;
    /// Maximum travel of the ball in a part, in radii. Test: Settings.AreNoticed.
    double part_travel_fraction = 0.5;
    /// Maximum number of parts of a step; the contact solver takes what needs more. Test: Settings.AreNoticed.
    int max_parts = 256;
    /// Maximum number of times that a part is halved where the ground is not found. Test:
    /// Settings.AreNoticed.
    int max_halvings = 6;
    /// Maximum number of planes of the ground that the ball is put onto in turn. Test: Settings.AreNoticed.
    int settle_iterations = 8;
    /// Speed below which a ball comes to rest, with a step of gravity added, m/s. Test:
    /// Settings.AreNoticed.
    double slow_speed = 2e-3;
    /// The same speed on ground that resists rolling, m/s. Test: Settings.AreNoticed.
    double slow_resisted_speed = 0.05;
    /// Depth from which on the ball's energy pays for lifting it out, m; up to that depth the contact solver carries
    /// it. Test: Settings.AreNoticed.
    double min_sag = 1e-5;
    /// Depth, in radii, beyond which the contact solver takes the ball out. Test: Settings.AreNoticed.
    double max_depth_fraction = 0.1;
    /// Separating speed over the speed along the ground, besides max_parting_speed, above which a ball that does not
    /// bounce leaves the ground. Test: Settings.AreNoticed.
    double max_parting_fraction = 0.02;
    /// Slip over the speed up to which a ball rolls at the start of a step. Test: Settings.AreNoticed.
    double roll_slip_fraction = 1e-3;
    /// Minimum of 1 + κ r, the width of a hollow over the ball's: a hollow that is narrower counts as this wide. Test:
    /// Settings.AreNoticed.
    double min_hollow_fraction = 0.2;
};

template <>
inline constexpr auto settings_of<BallPathSettings> = std::tuple{
    Setting{"part_turn", &BallPathSettings::part_turn, 1e-3, 1, "rad"},
    Setting{"part_travel_fraction", &BallPathSettings::part_travel_fraction, 1e-3, 10},
    Setting{"max_parts", &BallPathSettings::max_parts, 1, 1e5},
    Setting{"max_halvings", &BallPathSettings::max_halvings, 0, 20},
    Setting{"settle_iterations", &BallPathSettings::settle_iterations, 1, 1000},
    Setting{"slow_speed", &BallPathSettings::slow_speed, 0, 10, "m/s"},
    Setting{"slow_resisted_speed", &BallPathSettings::slow_resisted_speed, 0, 10, "m/s"},
    Setting{"min_sag", &BallPathSettings::min_sag, 0, 0.1, "m"},
    Setting{"max_depth_fraction", &BallPathSettings::max_depth_fraction, 1e-6, 1},
    Setting{"max_parting_fraction", &BallPathSettings::max_parting_fraction, 0, 1},
    Setting{"roll_slip_fraction", &BallPathSettings::roll_slip_fraction, 0, 1},
    Setting{"min_hollow_fraction", &BallPathSettings::min_hollow_fraction, 1e-3, 1},
};
static_assert(setting_count<BallPathSettings> == member_count<BallPathSettings>(), "a setting is in no list");

/// Balls that roll close to each other (src/physics/stages/rigid/ball_cluster.cpp).
struct BallClusterSettings {
    /// Gap, over the smaller radius, at which balls touch. Test: Settings.AreNoticed.
    double touch_fraction = 1e-6;
    /// Depth, over the smaller radius, beyond which the contact solver separates balls. Test: Settings.AreNoticed.
    double max_depth_fraction = 0.5;
    /// The same depth for balls that stay together. Test: Settings.AreNoticed.
    double max_rest_depth_fraction = 0.01;
    /// Maximum number of collisions of a pair in a step. Test: Settings.AreNoticed.
    std::size_t max_collisions = 64;
    /// Maximum number of further parts for each part and each pair in a step. Test: Settings.AreNoticed.
    int part_budget = 4;
    /// Maximum number of balls of a cluster: the time of one worker grows with the square of their number. Test:
    /// Settings.AreNoticed.
    std::size_t max_members = 32;
};

template <>
inline constexpr auto settings_of<BallClusterSettings> = std::tuple{
    Setting{"touch_fraction", &BallClusterSettings::touch_fraction, 1e-12, 0.1},
    Setting{"max_depth_fraction", &BallClusterSettings::max_depth_fraction, 0, 2},
    Setting{"max_rest_depth_fraction", &BallClusterSettings::max_rest_depth_fraction, 0, 2},
    Setting{"max_collisions", &BallClusterSettings::max_collisions, 1, 1e6},
    Setting{"part_budget", &BallClusterSettings::part_budget, 1, 1000},
    Setting{"max_members", &BallClusterSettings::max_members, 2, 1e6},
};
static_assert(setting_count<BallClusterSettings> == member_count<BallClusterSettings>(), "a setting is in no list");

}  // namespace embody::physics
