// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/impact_budget_settings.h"
#include "physics/definitions/settings/impact_solver_settings.h"
#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// When bodies collide, and where (src/physics/stages/impact).
struct ImpactSettings {
    /// Speed of approach below which surfaces rest on each other, m/s; of balls that roll together, too. Test:
    /// Settings.AreNoticed.
    double min_impact_speed = 0.02;
    /// The same of contacts that carry a load or do not bounce, over min_impact_speed: the contact solver stops them as
    /// well. Test: Settings.AreNoticed.
    double loaded_speed_ratio = 5;
    /// Substeps of gravity along the normal that an impact is at least as fast as: what rests is pressed by one. Test:
    /// Settings.AreNoticed.
    double min_impact_substeps = 2;
    /// Gap at which bodies touch, m. Test: Settings.AreNoticed.
    double touch_gap = 1e-6;
    /// Gap of corners to the first one that collide together with it, m: what they touch gives way for longer than
    /// that. Test: Settings.AreNoticed.
    double patch_gap = 5e-4;
    /// Turn in a step above which other corners may touch than were found at its start, rad. Test: Settings.AreNoticed.
    double max_followed_turn = 0.25;
    /// Points of the regula falsi for the moment of touch. Test: Settings.AreNoticed.
    int root_iterations = 8;
    /// Gap up to which surfaces are looked for at the moment of an impact, m. Test: Settings.AreNoticed.
    double search_margin = 0.02;
    /// Rounds in which the place and the moment of an impact are found. Test: Settings.AreNoticed.
    int refine_iterations = 8;
    /// The same of what hits a heap and does not bounce. Test: Settings.AreNoticed.
    int rough_refine_iterations = 4;
    /// Gap over patch_gap up to which the last of these rounds is good enough. Test: Settings.AreNoticed.
    double refine_gap_ratio = 10;
    /// The same of what hits a heap and does not bounce. Test: Settings.AreNoticed.
    double rough_refine_gap_ratio = 2;
    /// Share of the smaller body's size by which a pair may have moved since the start of the step for its contact to
    /// be right still, where what hits a heap does not bounce. Test: Settings.AreNoticed.
    double region_travel_fraction = 0.05;
    /// Restitution from which on bodies that touch pass a blow on one by one, as the balls of Newton's cradle do.
    /// Source: half of the energy comes back, 0.7² = 0.49. Test: Settings.AreNoticed.
    double elastic_restitution = 0.7;
    /// Share by which joints may change what they hold otherwise than in the last step, where contacts are left open
    /// for it. Test: Settings.AreNoticed.
    double held_acceleration_tolerance = 0.1;
    ImpactBudgetSettings budget;
    ImpactSolverSettings solver;
};

template <>
inline constexpr auto settings_of<ImpactSettings> = std::tuple{
    Setting{"min_impact_speed", &ImpactSettings::min_impact_speed, 1e-6, 10, "m/s"},
    Setting{"loaded_speed_ratio", &ImpactSettings::loaded_speed_ratio, 1, 1000},
    Setting{"min_impact_substeps", &ImpactSettings::min_impact_substeps, 0, 100},
    Setting{"touch_gap", &ImpactSettings::touch_gap, 1e-12, 1e-3, "m"},
    Setting{"patch_gap", &ImpactSettings::patch_gap, 1e-9, 0.1, "m"},
    Setting{"max_followed_turn", &ImpactSettings::max_followed_turn, 1e-3, 10, "rad"},
    Setting{"root_iterations", &ImpactSettings::root_iterations, 1, 1000},
    Setting{"search_margin", &ImpactSettings::search_margin, 1e-6, 1, "m"},
    Setting{"refine_iterations", &ImpactSettings::refine_iterations, 1, 1000},
    Setting{"rough_refine_iterations", &ImpactSettings::rough_refine_iterations, 1, 1000},
    Setting{"refine_gap_ratio", &ImpactSettings::refine_gap_ratio, 0, 1e6},
    Setting{"rough_refine_gap_ratio", &ImpactSettings::rough_refine_gap_ratio, 0, 1e6},
    Setting{"region_travel_fraction", &ImpactSettings::region_travel_fraction, 0, 1},
    Setting{"elastic_restitution", &ImpactSettings::elastic_restitution, 0, 1},
    Setting{"held_acceleration_tolerance", &ImpactSettings::held_acceleration_tolerance, 0, 10},
    Setting{"budget", &ImpactSettings::budget},
    Setting{"solver", &ImpactSettings::solver},
};
static_assert(setting_count<ImpactSettings> == member_count<ImpactSettings>(), "a setting is in no list");

}  // namespace embody::physics
