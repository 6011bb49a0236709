// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Sheets and how their own layers are kept apart (src/physics/deformable/cloth, docs/physics/cloth.md).
struct ClothSettings {
    /// Maximum linear solves in a substep, as long as contacts change in them or stretch is unforeseen. Test:
    /// Settings.AreNoticed.
    int max_solves = 8;
    /// Further solves in a substep with contacts of what would pass through each other. Test: Settings.AreNoticed.
    int max_meeting_solves = 4;
    /// Residual at which a solve ends, over that of min_gravity in the preconditioner's norm. Source: D. Baraff, A.
    /// Witkin, "Large steps in cloth simulation", 1998, section 5.3, end in that norm too. Test: Settings.AreNoticed.
    double gradient_tolerance = 5e-3;
    /// Energy of stretch that a solve's linear equations did not foresee, over that of the sheet's motion, above which
    /// the next solve is about the moves found. Test: ClothLanding.NothingIsGainedWhereASheetLands.
    double stretch_tolerance = 0.05;
    /// The same above which the substep is taken in parts at once. Source: moves that would take more energy than there
    /// is are no place to solve about. Test: Settings.AreNoticed.
    double max_stretch = 1;
    /// Maximum iterations of a solve. Test: Settings.AreNoticed.
    int max_gradient_iterations = 200;
    /// Maximum parts of a substep, for fast layers and for stretch that solves do not foresee. Test:
    /// Settings.AreNoticed.
    int max_parts = 16;
    /// Maximum relative displacement of layers in a part of a substep, over an edge's mean length. Source: beyond half
    /// an edge a node comes to a triangle that was no candidate. Test: Settings.AreNoticed.
    double max_layer_travel = 0.5;
    /// Distance within which features of a sheet at rest belong to one layer, over the distance that layers keep.
    /// Source: above the 2 within which contacts are looked for. Test: Settings.AreNoticed.
    double same_layer_reach = 3;
    /// Compliance of a node that lies on a body, over its own compliance: a node on a body moves last. Test:
    /// Settings.AreNoticed.
    double compliance_on_body = 0.05;
    /// Stiffness with which friction in bending begins, over the bend stiffness. Source: curves of fabrics on
    /// Kawabata's tester come to their friction within a fraction of 1/cm. Test: Settings.AreNoticed.
    double friction_stiffness = 4;
    /// Energy that a substep takes from a sheet with gas inside by the change of the whole's velocity, over that of its
    /// motion, above which the substep is taken in parts. Source: backward Euler takes ½ m Δv². Test:
    /// SheetGas.DroppedBallsBounceAndGainNothing.
    double bounce_tolerance = 0.02;
};

template <>
inline constexpr auto settings_of<ClothSettings> = std::tuple{
    Setting{"max_solves", &ClothSettings::max_solves, 1, 1000},
    Setting{"max_meeting_solves", &ClothSettings::max_meeting_solves, 0, 1000},
    Setting{"gradient_tolerance", &ClothSettings::gradient_tolerance, 1e-12, 1e3},
    Setting{"stretch_tolerance", &ClothSettings::stretch_tolerance, 0, 1e9},
    Setting{"max_stretch", &ClothSettings::max_stretch, 0, 1e9},
    Setting{"max_gradient_iterations", &ClothSettings::max_gradient_iterations, 1, 1e6},
    Setting{"max_parts", &ClothSettings::max_parts, 1, 64},
    Setting{"max_layer_travel", &ClothSettings::max_layer_travel, 1e-3, 1e3},
    Setting{"same_layer_reach", &ClothSettings::same_layer_reach, 2, 1e3},
    Setting{"compliance_on_body", &ClothSettings::compliance_on_body, 1e-6, 1},
    Setting{"friction_stiffness", &ClothSettings::friction_stiffness, 1e-3, 1e3},
    Setting{"bounce_tolerance", &ClothSettings::bounce_tolerance, 0, 1e9},
};
static_assert(setting_count<ClothSettings> == member_count<ClothSettings>(), "a setting is in no list");

/// Ropes (src/physics/deformable/rope, docs/physics/ropes.md), also where they are solved together with sheets.
struct RopeSettings {
    /// Maximum iterations of Newton's method in a substep. Test: Settings.AreNoticed.
    int max_iterations = 40;
    /// Displacement of the fastest node in an iteration at which the iterations end, over a segment's length. Test:
    /// Settings.AreNoticed.
    double move_tolerance = 1e-4;
    /// The same displacement where ropes are solved together with sheets, which are solved in floats and to
    /// gradient_tolerance. Test: Settings.AreNoticed.
    double move_tolerance_together = 1e-3;
    /// Fraction of an iteration's step below which the line search ends. Source: ten tries, each of half the step;
    /// where the energy falls at all, it has fallen by then. Test: Settings.AreNoticed.
    double min_step_fraction = 1e-3;
    /// As ThinContactSettings::change_tolerance. Source: along a drum errors add up in the exponent. Test:
    /// Settings.AreNoticed.
    double change_tolerance = 0.005;
    /// Stiffness of a contact with a body over that of the node in the contact's direction. Source: as
    /// ThinContactSettings::stiffness_factor; what turns with a drum takes the fewer iterations the softer it is, and
    /// below 2 a rope slides through a box's edge. Test: Atwood.OverATurningDrum.
    double contact_stiffness_factor = 2;
    /// 1 + cosine between segments below which the curvature of a clamped rope grows no further. Source: at 0.02 the
    /// rope is folded back by 168 degrees; the curvature of M. Bergou et al., "Discrete elastic rods", 2008, eq. 1,
    /// goes to infinity at 180. Test: Settings.AreNoticed.
    double fold_limit = 0.02;
};

template <>
inline constexpr auto settings_of<RopeSettings> = std::tuple{
    Setting{"max_iterations", &RopeSettings::max_iterations, 1, 1e4},
    Setting{"move_tolerance", &RopeSettings::move_tolerance, 0, 1},
    Setting{"move_tolerance_together", &RopeSettings::move_tolerance_together, 0, 1},
    Setting{"min_step_fraction", &RopeSettings::min_step_fraction, 1e-12, 0.5},
    Setting{"change_tolerance", &RopeSettings::change_tolerance, 0, 1},
    Setting{"contact_stiffness_factor", &RopeSettings::contact_stiffness_factor, 1, 1e4},
    Setting{"fold_limit", &RopeSettings::fold_limit, 1e-6, 2},
};
static_assert(setting_count<RopeSettings> == member_count<RopeSettings>(), "a setting is in no list");

}  // namespace embody::physics
