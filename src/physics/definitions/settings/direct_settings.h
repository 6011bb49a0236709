// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// The direct solver of contacts (src/physics/constraint/direct; docs/physics/direct-solver.md).
struct DirectSettings {
    /// Speed of all points of an island below which it is solved once a step, if they stay slower, m/s. Test:
    /// Settings.AreNoticed.
    double slow_speed = 0.02;
    /// Maximum change of speed with which the last impulses still count as holding their bodies, m/s, rad/s. Source:
    /// stored in floats, they leave 1e-7 of what a step of gravity changes, 0.16. Test: Settings.AreNoticed.
    double held_speed_tolerance = 1e-6;
    /// Gap or depth that loaded points at rest may have, m. Source: at rest's k, one micrometre would unload a point,
    /// docs/physics/direct-solver.md. Test: Settings.AreNoticed.
    double rest_gap_tolerance = 2e-5;
    /// Fraction of a gap or a depth that is closed in the one solve of a step at rest. Test: Settings.AreNoticed.
    double rest_correction_fraction = 0.5;
    /// The same fraction in a substep of moving bodies: lifting is work that a rocking column keeps. Test:
    /// Settings.AreNoticed.
    double moving_correction_fraction = 0.005;
    /// Gap or depth of loaded points below which nothing is closed in motion, m. Test: Settings.AreNoticed.
    double moving_gap_tolerance = 1e-7;
    /// Maximum displacement of a body by corrections in a step at rest, m. Test: Settings.AreNoticed.
    double max_rest_shift = 2e-3;
    /// Cost of an iteration, in products of 6×6 blocks, up to which a slow island that sweeps could solve as well is
    /// solved directly. Source: measured, docs/physics/direct-solver.md: a wall of 210 cubes takes 13,900. Test:
    /// Settings.AreNoticed.
    std::size_t max_products_slow = 16000;
    /// Cost of all such iterations of a step after which no other is begun. Source: 3 to 7 ms by the measurements of
    /// docs/physics/direct-solver.md. Test: Settings.AreNoticed.
    std::size_t max_products_step = 60000;
    /// Stiffness k of the augmented Lagrangian over the heaviest mass. Source: one solve without a guess is then right
    /// to the inverse of this ratio, and doubles hold it up to ratios of masses of 1e6. Test: Settings.AreNoticed.
    double stiffness_per_mass = 1e5;
    /// Fraction of k that is used where the sweeps' loads are the guess for bodies at rest: with all of k, a point that
    /// is left out lets its body fall so far that many other points stop it. Source: docs/physics/direct-solver.md, "At
    /// rest". Test: Settings.AreNoticed.
    double rest_stiffness_fraction = 1e-2;
    /// The same fraction where the guess is the loads of the step before, which found the bodies at rest. Test:
    /// Settings.AreNoticed.
    double settling_stiffness_fraction = 0.1;
    /// Maximum iterations of Newton's method with whole steps. Test: Settings.AreNoticed.
    int undamped_iterations = 4;
    /// Maximum further iterations with steps as far as f falls. Test: Settings.AreNoticed.
    int lagged_iterations = 8;
    /// Maximum iterations for bodies at rest. Test: Settings.AreNoticed.
    int rest_iterations = 16;
    /// Fraction of the slope along a step at which the line search ends. Source: J. Nocedal, S. Wright, "Numerical
    /// optimization", 2006, 3.1: 0.9 is usual with Newton's method; this is the 0.1 of nonlinear conjugate gradients.
    /// Test: Settings.AreNoticed.
    double line_search_tolerance = 0.1;
    /// Maximum points of a line search. Test: Settings.AreNoticed.
    int line_search_iterations = 12;
    /// Maximum error of the impulses of a last step, over the largest load. Source: the rounding of the floats that
    /// store them. Test: Settings.AreNoticed.
    double force_tolerance = 1e-7;
    /// Relative error of the metric of friction up to which it is kept, and with it the factors. Test:
    /// Settings.AreNoticed.
    double metric_tolerance = 0.02;
    /// Separating speed up to which new points are taken as loaded in the first iteration, m/s. Test:
    /// Settings.AreNoticed.
    double new_contact_speed = 1e-3;
    /// Lever arm of the twist, over the patch's extent, below which it is rounding and a single point is loaded.
    /// Source: the floats of the sweeps leave 1e-7, docs/physics/direct-solver.md. Test: Settings.AreNoticed.
    double min_spin_arm_fraction = 1e-3;
    /// Steps to the next attempt after a first failure; the number doubles with each further failure. Test:
    /// Settings.AreNoticed.
    std::uint64_t min_idle_steps = 15;
    /// Maximum steps to the next attempt after many failures: 16 s at 60 Hz. Test: Settings.AreNoticed.
    std::uint64_t max_idle_steps = 960;
    /// Steps in a row found at rest after which a list that its last impulses do not hold is taken as never held by
    /// them. Test: Settings.AreNoticed.
    std::uint64_t max_rest_steps = 60;
    /// Steps for which what was found about an unused graph is kept: after these another graph may take its place.
    /// Test: Settings.AreNoticed.
    std::uint64_t memory_steps = 60;
};

template <>
inline constexpr auto settings_of<DirectSettings> = std::tuple{
    Setting{"slow_speed", &DirectSettings::slow_speed, 1e-6, 10, "m/s"},
    Setting{"held_speed_tolerance", &DirectSettings::held_speed_tolerance, 1e-12, 1, "m/s"},
    Setting{"rest_gap_tolerance", &DirectSettings::rest_gap_tolerance, 0, 0.01, "m"},
    Setting{"rest_correction_fraction", &DirectSettings::rest_correction_fraction, 0, 1},
    Setting{"moving_correction_fraction", &DirectSettings::moving_correction_fraction, 0, 1},
    Setting{"moving_gap_tolerance", &DirectSettings::moving_gap_tolerance, 0, 0.01, "m"},
    Setting{"max_rest_shift", &DirectSettings::max_rest_shift, 1e-6, 1, "m"},
    Setting{"max_products_slow", &DirectSettings::max_products_slow, 0, 1e9},
    Setting{"max_products_step", &DirectSettings::max_products_step, 0, 1e9},
    Setting{"stiffness_per_mass", &DirectSettings::stiffness_per_mass, 10, 1e9},
    Setting{"rest_stiffness_fraction", &DirectSettings::rest_stiffness_fraction, 1e-6, 1},
    Setting{"settling_stiffness_fraction", &DirectSettings::settling_stiffness_fraction, 1e-6, 1},
    Setting{"undamped_iterations", &DirectSettings::undamped_iterations, 0, 1000},
    Setting{"lagged_iterations", &DirectSettings::lagged_iterations, 0, 1000},
    Setting{"rest_iterations", &DirectSettings::rest_iterations, 1, 1000},
    Setting{"line_search_tolerance", &DirectSettings::line_search_tolerance, 1e-12, 1},
    Setting{"line_search_iterations", &DirectSettings::line_search_iterations, 1, 1000},
    Setting{"force_tolerance", &DirectSettings::force_tolerance, 1e-15, 0.1},
    Setting{"metric_tolerance", &DirectSettings::metric_tolerance, 0, 1},
    Setting{"new_contact_speed", &DirectSettings::new_contact_speed, 0, 10, "m/s"},
    Setting{"min_spin_arm_fraction", &DirectSettings::min_spin_arm_fraction, 1e-9, 1},
    Setting{"min_idle_steps", &DirectSettings::min_idle_steps, 1, 1e9},
    Setting{"max_idle_steps", &DirectSettings::max_idle_steps, 1, 1e9},
    Setting{"max_rest_steps", &DirectSettings::max_rest_steps, 1, 1e9},
    Setting{"memory_steps", &DirectSettings::memory_steps, 0, 1e9},
};
static_assert(setting_count<DirectSettings> == member_count<DirectSettings>(), "a setting is in no list");

}  // namespace embody::physics
