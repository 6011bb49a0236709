// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/impact_budget_settings.h"
#include "physics/definitions/settings/impact_solver_settings.h"
#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// When bodies collide, and where (src/physics/stages/impact).
struct ImpactSettings {
    /// Speed of approach below which surfaces rest on each other, m/s; also for balls that roll together. Test:
    /// Settings.AreNoticed.
    double min_impact_speed = 0.02;
    /// The same speed for contacts that carry a load or do not bounce, over min_impact_speed: the contact solver stops
    /// these as well as an impact would. Test: Settings.AreNoticed.
    double loaded_speed_ratio = 5;
    /// Minimum speed of an impact, in the speed that gravity along the normal gives in a substep: resting bodies are
    /// pressed by one substep of it. Test: Settings.AreNoticed.
    double min_impact_substeps = 2;
    /// Gap at which bodies touch, m. Test: Settings.AreNoticed.
    double touch_gap = 1e-6;
    /// Maximum gap of corners that collide together with the first one, m: a surface deforms by more than that. Test:
    /// Settings.AreNoticed.
    double patch_gap = 5e-4;
    /// Turn of a body in a step above which other corners may touch than those found at the start, rad. Test:
    /// Settings.AreNoticed.
    double max_followed_turn = 0.25;
    /// Maximum points of the regula falsi for the moment of touch. Test: Settings.AreNoticed.
    int root_iterations = 8;
    /// Gap up to which surfaces are looked for at the moment of an impact, m. Test: Settings.AreNoticed.
    double search_margin = 0.02;
    /// Maximum iterations that find the place and the moment of an impact. Test: Settings.AreNoticed.
    int refine_iterations = 8;
    /// The same for a body that hits a pile and does not bounce. Test: Settings.AreNoticed.
    int rough_refine_iterations = 4;
    /// Gap over patch_gap up to which the last of these iterations is accurate enough. Test: Settings.AreNoticed.
    double refine_gap_ratio = 10;
    /// Displacement of a pair since the start of the step, over the smaller body's size, up to which its contact is
    /// still accurate enough, for a body that hits a pile and does not bounce. Test: Settings.AreNoticed.
    double region_travel_fraction = 0.05;
    /// Restitution from which on bodies that touch pass an impact on one by one, as the balls of Newton's cradle do.
    /// Source: half of the energy comes back, 0.7² = 0.49. Test: Settings.AreNoticed.
    double elastic_restitution = 0.7;
    /// Relative change of a joint's effect since the last step that is allowed for where contacts are left open for it.
    /// Test: Settings.AreNoticed.
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
    Setting{"region_travel_fraction", &ImpactSettings::region_travel_fraction, 0, 1},
    Setting{"elastic_restitution", &ImpactSettings::elastic_restitution, 0, 1},
    Setting{"held_acceleration_tolerance", &ImpactSettings::held_acceleration_tolerance, 0, 10},
    Setting{"budget", &ImpactSettings::budget},
    Setting{"solver", &ImpactSettings::solver},
};
static_assert(setting_count<ImpactSettings> == member_count<ImpactSettings>(), "a setting is in no list");

}  // namespace embody::physics
