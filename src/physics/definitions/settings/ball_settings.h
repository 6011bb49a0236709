// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// A ball along still ground (src/physics/constraint/rolling/ball_path.cpp).
struct BallPathSettings {
    /// Turn of the normal, or of the phase of a swing, in a part of the step, rad. Test: Settings.AreNoticed.
    double part_turn = 0.06;
    /// Way of the ball in a part, of its radius. Test: Settings.AreNoticed.
    double part_travel_fraction = 0.5;
    /// Parts of a step; what needs more is the contact solver's. Test: Settings.AreNoticed.
    int max_parts = 256;
    /// Times that a part is halved where the ground is not found. Test: Settings.AreNoticed.
    int max_halvings = 6;
    /// Planes of the ground that the ball is put onto in turn. Test: Settings.AreNoticed.
    int settle_iterations = 8;
    /// Speed below which a ball comes to rest, with a step of gravity added, m/s. Test: Settings.AreNoticed.
    double slow_speed = 2e-3;
    /// The same on ground that resists rolling, m/s. Test: Settings.AreNoticed.
    double slow_resisted_speed = 0.05;
    /// Depth from which on its energy pays for lifting the ball out, m; so deep the contact solver carries it. Test:
    /// SleepOnlyInBalance.ABallRollsDownTheGentlestSlope.
    double min_sag = 1e-5;
    /// Depth, of the radius, beyond which the contact solver takes the ball out. Test: Settings.AreNoticed.
    double max_depth_fraction = 0.1;
    /// Speed of parting over that along the ground, besides max_parting_speed, above which a ball that does not bounce
    /// leaves it. Test: Settings.AreNoticed.
    double max_parting_fraction = 0.02;
    /// Slip over the speed up to which a ball rolls at the start of a step. Test: Settings.AreNoticed.
    double roll_slip_fraction = 1e-3;
    /// Gap, of the radius, up to which ground is looked for after a part besides what smooth edges turn. Test:
    /// Settings.AreNoticed.
    double settle_margin_fraction = 1e-3;
    /// Width of a hollow over the ball, 1 + κ r, below which it counts as so wide: it is hardly wider than the ball.
    /// Test: Settings.AreNoticed.
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
    Setting{"settle_margin_fraction", &BallPathSettings::settle_margin_fraction, 0, 1},
    Setting{"min_hollow_fraction", &BallPathSettings::min_hollow_fraction, 1e-3, 1},
};
static_assert(setting_count<BallPathSettings> == member_count<BallPathSettings>(), "a setting is in no list");

/// Balls that roll near each other (src/physics/stages/rigid/ball_cluster.cpp).
struct BallClusterSettings {
    /// Gap, of the smaller radius, at which balls touch. Test: Settings.AreNoticed.
    double touch_fraction = 1e-6;
    /// Depth, of the smaller radius, beyond which the contact solver takes balls out of each other. Test:
    /// Settings.AreNoticed.
    double max_depth_fraction = 0.5;
    /// The same of balls that stay together. Test: Settings.AreNoticed.
    double max_rest_depth_fraction = 0.01;
    /// Collisions of a pair in a step. Test: Settings.AreNoticed.
    std::size_t max_collisions = 64;
    /// Parts for each part and each pair in a step. Test: Settings.AreNoticed.
    int part_budget = 4;
    /// Balls of a cluster: the time of one worker grows with the square of their number. Test: Settings.AreNoticed.
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
