// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Soft solids: their elements and their step (src/physics/deformable/solid).
struct SolidSettings {
    /// Fraction of the energy of a change of form that is told by the means around the nodes; the rest is told by the
    /// tetrahedra, which bend too stiffly. Source: fitted to bars and rods, docs/physics/deformables.md; the method is
    /// of G. R. Liu, T. Nguyen-Thoi, K. Y. Lam, "A novel alpha finite element method", 2008. Test:
    /// SoftLaws.BarsTwistAsSaintVenantSays, SoftLaws.CantileversBendAsTimoshenkoSays.
    double node_fraction = 0.7;
    /// Plastic strain beyond which matter flows no further, so that no element is rolled out to zero thickness. Source:
    /// J. F. O'Brien, A. W. Bargteil, J. K. Hodgins, "Graphical modeling and animation of ductile fracture", 2002,
    /// bound it too. Test: Settings.AreNoticed.
    double max_plastic_strain = 0.5;
    /// Fraction of its volume at rest below which the pressure of enclosed gas grows no further. Test:
    /// Settings.AreNoticed.
    double min_gas_fraction = 0.05;
    /// True stiffness along a move over the metric's above which the factor is made anew. Source: a move by the metric
    /// goes too far by the ratio less 1, so moves grow from a ratio of 2 on. Test: Settings.AreNoticed.
    double max_stiffness_ratio = 1.3;
    /// Maximum further iterations in a substep for solids whose moves add energy. Test: Settings.AreNoticed.
    int max_corrections = 3;
    /// Maximum energy that a solid may gain in a substep, over its energy, by rounding and by rotations that lag. Test:
    /// Settings.AreNoticed.
    double max_energy_gain = 0.01;
    /// Travel of the fastest node in a substep, over a triangle's mean side, below which no energy is measured. Source:
    /// rotations lag by about that many radians, and the error of a strain's energy is the square of that. Test:
    /// Settings.AreNoticed.
    double energy_travel_fraction = 0.02;
    /// How often a move that adds energy is halved; the last time it becomes zero. Test: Settings.AreNoticed.
    int max_halvings = 4;
    /// Maximum turn by which the velocities of a new solid are turned back, rad: that of half a substep, where the
    /// solid's spin is slow enough to be followed. Test: SoftSolid.ASpinBeyondWhatStepsCanFollowMakesNoEnergy.
    double max_turn_back = 0.3;
};

template <>
inline constexpr auto settings_of<SolidSettings> = std::tuple{
    Setting{"node_fraction", &SolidSettings::node_fraction, 0, 1},
    Setting{"max_plastic_strain", &SolidSettings::max_plastic_strain, 1e-4, 100},
    Setting{"min_gas_fraction", &SolidSettings::min_gas_fraction, 1e-4, 1},
    Setting{"max_stiffness_ratio", &SolidSettings::max_stiffness_ratio, 0.01, 1e3},
    Setting{"max_corrections", &SolidSettings::max_corrections, 0, 1000},
    Setting{"max_energy_gain", &SolidSettings::max_energy_gain, 0, 1e3},
    Setting{"energy_travel_fraction", &SolidSettings::energy_travel_fraction, 0, 1e3},
    Setting{"max_halvings", &SolidSettings::max_halvings, 1, 50},
    Setting{"max_turn_back", &SolidSettings::max_turn_back, 0, 10, "rad"},
};
static_assert(setting_count<SolidSettings> == member_count<SolidSettings>(), "a setting is in no list");

/// Contacts of soft solids with bodies and each other: how they are found, and their forces.
struct SolidContactSettings {
    /// Maximum iterations, each of sweeps and a solve of all forces at once. Source of the method: M. Silcowitz, S.
    /// Niebe, K. Erleben, "Projected Gauss-Seidel subspace minimization method", 2010. Test: Settings.AreNoticed.
    int max_iterations = 5;
    /// Sweeps over the contacts in an iteration. Test: Settings.AreNoticed.
    int sweeps_per_iteration = 2;
    /// Maximum sweeps with conjugate directions after the iterations, where these have not converged. Source of the
    /// method: the same authors, "A nonsmooth nonlinear conjugate gradient method", 2010. Test: Settings.AreNoticed.
    int max_conjugate_sweeps = 10;
    /// Maximum iterations of the solve of all forces at once. Test: Settings.AreNoticed.
    int gradient_iterations = 8;
    /// Square of the residual over that of the first one, in the preconditioner's norm, at which that solve ends. Test:
    /// Settings.AreNoticed.
    double gradient_tolerance = 0.01;
    /// Displacement of any contact in the last sweep below which the forces have converged, m. Test:
    /// Settings.AreNoticed.
    double sweep_tolerance = 2e-6;
    /// The same, over the displacements of the first sweeps: forces are kept for the next substep. Test:
    /// Settings.AreNoticed.
    double sweep_tolerance_of_first = 0.05;
    /// The same, over the maximum travel by which any pair slides or closes in the substep. Test: Settings.AreNoticed.
    double sweep_tolerance_of_slip = 0.02;
    /// Displacement below which a contact is left as it is in a sweep, m. Source: a twentieth of sweep_tolerance. Test:
    /// Settings.AreNoticed.
    double idle_move = 1e-7;
    /// Compliance of a contact along its normal over that of what it touches: where contacts are redundant, each bears
    /// a part of the load. Test: Settings.AreNoticed.
    double softness = 0.01;
    /// Maximum speed at which overlaps and errors of attachments are corrected, m/s. Test:
    /// SoftSolid.ThoseThatBeginWithinEachOtherPartGently.
    double recovery_speed = 0.5;
    /// Gap beyond which contacts without force stay out of the sweeps, in contact radii. Test: Settings.AreNoticed.
    double reach_radii = 1;
    /// Fraction of one solid's volume within another from which on the two are separated as a whole: contacts never let
    /// so much in. Test: SoftSolid.ThoseThatBeginWithinEachOtherPartGently.
    double parting_fraction = 0.125;
    /// Depth of the points that count for that fraction, over a triangle's mean side: contacts never leave a node so
    /// deep in a step. Test: Settings.AreNoticed.
    double parting_depth = 0.5;
    /// The same depth while the two are being separated: until no point is so deep. Test: Settings.AreNoticed.
    double parted_depth = 0.1;
    /// Number of sample points of a surface. Source: with 64, a fraction of an eighth, parting_fraction, is known to a
    /// third. Test: Settings.AreNoticed.
    std::size_t parting_samples = 64;
    /// Mean of a body's normals at the nodes within it above which its faces push to one side and separate the two by
    /// themselves. Test: BeginsInside.ASoftCubeLeavesABoxWhole.
    double one_side_cosine = 0.5;
    /// Reach of a body, over a triangle's mean side, below which nodes may miss the body: contacts of its corners and
    /// balls are looked for, too. Test: SoftSolid.ABallSmallerThanItsElementsStaysOn.
    double feature_body_ratio = 1.5;
};

template <>
inline constexpr auto settings_of<SolidContactSettings> = std::tuple{
    Setting{"max_iterations", &SolidContactSettings::max_iterations, 0, 1e5},
    Setting{"sweeps_per_iteration", &SolidContactSettings::sweeps_per_iteration, 1, 1000},
    Setting{"max_conjugate_sweeps", &SolidContactSettings::max_conjugate_sweeps, 0, 1e5},
    Setting{"gradient_iterations", &SolidContactSettings::gradient_iterations, 1, 1e5},
    Setting{"gradient_tolerance", &SolidContactSettings::gradient_tolerance, 0, 1},
    Setting{"sweep_tolerance", &SolidContactSettings::sweep_tolerance, 0, 1, "m"},
    Setting{"sweep_tolerance_of_first", &SolidContactSettings::sweep_tolerance_of_first, 0, 1},
    Setting{"sweep_tolerance_of_slip", &SolidContactSettings::sweep_tolerance_of_slip, 0, 1},
    Setting{"idle_move", &SolidContactSettings::idle_move, 0, 1, "m"},
    Setting{"softness", &SolidContactSettings::softness, 0, 10},
    Setting{"recovery_speed", &SolidContactSettings::recovery_speed, 0, 1e3, "m/s"},
    Setting{"reach_radii", &SolidContactSettings::reach_radii, 0, 1e3},
    Setting{"parting_fraction", &SolidContactSettings::parting_fraction, 1e-3, 1},
    Setting{"parting_depth", &SolidContactSettings::parting_depth, 0, 100},
    Setting{"parted_depth", &SolidContactSettings::parted_depth, 0, 100},
    Setting{"parting_samples", &SolidContactSettings::parting_samples, 1, 1e6},
    Setting{"one_side_cosine", &SolidContactSettings::one_side_cosine, 0, 1},
    Setting{"feature_body_ratio", &SolidContactSettings::feature_body_ratio, 0, 1e3},
};
static_assert(setting_count<SolidContactSettings> == member_count<SolidContactSettings>(), "a setting is in no list");

}  // namespace embody::physics
