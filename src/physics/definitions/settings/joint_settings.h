// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Joints: all at once (src/physics/constraint/joint) and one by one (sweeps/substep_solver).
struct JointSettings {
    /// Maximum speed at which errors are corrected, m/s, rad/s: bodies that a user joined far apart come together
    /// without bursting. Test: Settings.AreNoticed.
    double max_correction_speed = 5;
    /// Turn of a body in a substep above which its pose after the drift is useless, rad; the speed of the rows is then
    /// used in place of the displacement. Test: Settings.AreNoticed.
    double max_drift_turn = 1;
    /// Remaining speed of a row below which the row is solved, m/s, rad/s. Source: far above the rounding of doubles,
    /// 1e-16 of the speeds, and 0.1 µm of drift in a thousand seconds. Test: Settings.AreNoticed.
    double speed_tolerance = 1e-10;
    /// The same speed where iterations make no further progress, m/s, rad/s. Test: Settings.AreNoticed.
    double rounding_tolerance = 1e-6;
    /// Speed of a row above which the method is taken as diverged, m/s, rad/s. Test: Settings.AreNoticed.
    double divergence_speed = 1e6;
    /// Error of an iteration over the last one's above which rounding allows no further progress. Test:
    /// Settings.AreNoticed.
    double stagnation_ratio = 0.25;
    /// Error of an iteration over the last one's above which the next iteration factorises anew. Source: one digit an
    /// iteration, the modified Newton method. Test: Settings.AreNoticed.
    double refactor_ratio = 0.1;
    /// Error of an iteration over the last one's above which the method is taken as diverging, after
    /// nonmonotone_iterations. Test: Settings.AreNoticed.
    double max_error_ratio = 0.5;
    /// Iterations of Newton's method in which the error may rise. Source of the method: L. Grippo, F. Lampariello, S.
    /// Lucidi, "A nonmonotone line search technique for Newton's method", 1986. Test: Settings.AreNoticed.
    int nonmonotone_iterations = 4;
    /// Maximum iterations of Newton's method. Test: Settings.AreNoticed.
    int max_iterations = 20;
    /// Maximum number of times that a substep is halved where the method diverges. Test: Settings.AreNoticed.
    int max_halvings = 4;
    /// Relative energy error up to which joints may seem to do work without the velocities being scaled. Source:
    /// rounding leaves 1e-15 a joint. Test: Settings.AreNoticed.
    double energy_tolerance = 1e-9;
    /// Compliance E of a row over its own J M⁻¹ Jᵀ: rows of a loop may be redundant. Source: far above the rounding of
    /// 1e-16, and the next iteration corrects the error that it makes. Test: Settings.AreNoticed.
    double regularisation = 1e-10;
    /// Joints times passes for a list that is too long to be solved at once. Test: Settings.AreNoticed.
    int sweep_budget = 512;
    /// Minimum passes over such a list in each phase. Test: Settings.AreNoticed.
    int min_sweeps = 4;
    /// Maximum passes over a short list, unless its error is gone. Test: Settings.AreNoticed.
    int max_sweeps = 64;
    /// Remaining speed of a row, m/s, rad/s, above which the impulses are no guess for the next substep: their
    /// oscillation would grow. Test: JointChain.TooLongForOneSolveStaysWhereItIs.
    double warm_start_tolerance = 1e-3;
    /// Fraction of the speed that is kept where contacts added energy to a jointed island, at or below which their
    /// impulses are no guess for the next substep. Test: Settings.AreNoticed.
    double warm_start_kept_fraction = 0.7;
};

template <>
inline constexpr auto settings_of<JointSettings> = std::tuple{
    Setting{"max_correction_speed", &JointSettings::max_correction_speed, 1e-3, 1000, "m/s"},
    Setting{"max_drift_turn", &JointSettings::max_drift_turn, 1e-3, 100, "rad"},
    Setting{"speed_tolerance", &JointSettings::speed_tolerance, 1e-14, 1e-3, "m/s"},
    Setting{"rounding_tolerance", &JointSettings::rounding_tolerance, 1e-14, 1, "m/s"},
    Setting{"divergence_speed", &JointSettings::divergence_speed, 1, 1e12, "m/s"},
    Setting{"stagnation_ratio", &JointSettings::stagnation_ratio, 0, 1},
    Setting{"refactor_ratio", &JointSettings::refactor_ratio, 0, 1},
    Setting{"max_error_ratio", &JointSettings::max_error_ratio, 0, 1000},
    Setting{"nonmonotone_iterations", &JointSettings::nonmonotone_iterations, 0, 1000},
    Setting{"max_iterations", &JointSettings::max_iterations, 1, 1000},
    Setting{"max_halvings", &JointSettings::max_halvings, 0, 16},
    Setting{"energy_tolerance", &JointSettings::energy_tolerance, 0, 1},
    Setting{"regularisation", &JointSettings::regularisation, 1e-15, 1e-3},
    Setting{"sweep_budget", &JointSettings::sweep_budget, 1, 1e6},
    Setting{"min_sweeps", &JointSettings::min_sweeps, 1, 1000},
    Setting{"max_sweeps", &JointSettings::max_sweeps, 1, 1e6},
    Setting{"warm_start_tolerance", &JointSettings::warm_start_tolerance, 0, 1000, "m/s"},
    Setting{"warm_start_kept_fraction", &JointSettings::warm_start_kept_fraction, 0, 1},
};
static_assert(setting_count<JointSettings> == member_count<JointSettings>(), "a setting is in no list");

}  // namespace embody::physics
