// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// The pressure's equation, also where it moves liquid that catches up with a body (src/physics/fluid/pressure,
/// solver.cpp, particles/catch_up.cpp).
struct FluidPressureSettings {
    /// Minimum distance from a liquid cell's centre to the surface in the equation, cells: smaller distances make the
    /// matrix stiff. Test: Settings.AreNoticed.
    float min_gap = 0.005f;
    /// Change of a cell's volume that the solve leaves in a part of a step, over the volume. Test: Settings.AreNoticed.
    double tolerance = 1e-4;
    /// The same where the liquid is moved to catch up with a body: this happens once a step, not in each part. Test:
    /// Settings.AreNoticed.
    double catch_up_tolerance = 1e-3;
    /// Maximum iterations of a solve; the report says where they did not suffice. Test: Settings.AreNoticed.
    int max_iterations = 300;
    /// Fraction of what the incomplete Cholesky factor leaves out that is put on the diagonal, 0 … 1. Source: R.
    /// Bridson, "Fluid Simulation for Computer Graphics", 2nd edition 2015, 5.3, "Modified Incomplete Cholesky" (τ).
    double cholesky_modification = 0.97;
    /// Fraction of the diagonal below which the factor takes the diagonal itself. Source: R. Bridson 2015, 5.3 (σ).
    double cholesky_safety = 0.25;
};

template <>
inline constexpr auto settings_of<FluidPressureSettings> = std::tuple{
    Setting{"min_gap", &FluidPressureSettings::min_gap, 1e-6, 1, "cells"},
    Setting{"tolerance", &FluidPressureSettings::tolerance, 1e-12, 1},
    Setting{"catch_up_tolerance", &FluidPressureSettings::catch_up_tolerance, 1e-12, 1},
    Setting{"max_iterations", &FluidPressureSettings::max_iterations, 1, 1e6},
    Setting{"cholesky_modification", &FluidPressureSettings::cholesky_modification, 0, 1},
    Setting{"cholesky_safety", &FluidPressureSettings::cholesky_safety, 1e-3, 1},
};
static_assert(setting_count<FluidPressureSettings> == member_count<FluidPressureSettings>(), "a setting is in no list");

/// How particles are moved against clumping (FluidSolver::spread_out, after T. Kugelstadt and others 2019).
struct FluidVolumeSettings {
    /// Fraction of the density's error that a part of a step corrects. Test: Settings.AreNoticed.
    double correction_fraction = 0.5;
    /// Minimum error of a cell's density that counts, over the liquid's density. Test: Settings.AreNoticed.
    double max_error = 0.5;
    /// Error that the solve leaves, over the liquid's density. Test: Settings.AreNoticed.
    double tolerance = 0.02;
    /// Maximum iterations; where they do not suffice, the next part continues. Test: Settings.AreNoticed.
    int max_iterations = 40;
};

template <>
inline constexpr auto settings_of<FluidVolumeSettings> = std::tuple{
    Setting{"correction_fraction", &FluidVolumeSettings::correction_fraction, 1e-3, 1},
    Setting{"max_error", &FluidVolumeSettings::max_error, 1e-3, 10},
    Setting{"tolerance", &FluidVolumeSettings::tolerance, 1e-9, 1},
    Setting{"max_iterations", &FluidVolumeSettings::max_iterations, 1, 1e6},
};
static_assert(setting_count<FluidVolumeSettings> == member_count<FluidVolumeSettings>(), "a setting is in no list");

/// Viscosity, and how much liquids stick to walls (src/physics/fluid/pressure/viscosity.cpp). The diffusion number ν
/// dt/h² is the square of the distance, in cells, over which a velocity spreads in a part of a step.
struct FluidViscositySettings {
    /// Diffusion number up to which viscosity is left out. Source: water on cells of 3 mm at 60 Hz has 2e-3 and on
    /// cells of 1.5 cm 7e-5. Test: Settings.AreNoticed.
    double min_diffusion_number = 1e-4;
    /// Diffusion number of liquid that does not yield: a larger one takes too many iterations, with a smaller one the
    /// liquid creeps. Test: FluidViscosity.AYieldStressSlowsTheFilmAsBinghamSaysAndHoldsItAboveTheStressAtTheGround.
    double max_diffusion_number = 200;
    /// Minimum distance from a face to a wall in the shear, cells. Test: Settings.AreNoticed.
    double min_wall_distance = 0.1;
    /// Minimum liquid fraction of a control volume: no face has less inertia, and cells in air with less have no
    /// viscosity. Test: Settings.AreNoticed.
    float min_fraction = 0.05f;
    /// A cell's Reynolds number at which liquid sticks to walls by half: then the layer at the wall is as thick as a
    /// cell or so. Test: Settings.AreNoticed.
    double stick_reynolds = 4;
    /// Minimum speed in this number, m/s. Test: Settings.AreNoticed.
    double min_stick_speed = 1e-3;
    /// Residual that the solve leaves, over the first residual. Test: Settings.AreNoticed.
    double tolerance = 1e-4;
    /// Maximum iterations; the report says where they did not suffice. Test: Settings.AreNoticed.
    int max_iterations = 300;
};

template <>
inline constexpr auto settings_of<FluidViscositySettings> = std::tuple{
    Setting{"min_diffusion_number", &FluidViscositySettings::min_diffusion_number, 0, 1e6},
    Setting{"max_diffusion_number", &FluidViscositySettings::max_diffusion_number, 1e-3, 1e6},
    Setting{"min_wall_distance", &FluidViscositySettings::min_wall_distance, 1e-3, 1, "cells"},
    Setting{"min_fraction", &FluidViscositySettings::min_fraction, 1e-3, 1},
    Setting{"stick_reynolds", &FluidViscositySettings::stick_reynolds, 1e-6, 1e9},
    Setting{"min_stick_speed", &FluidViscositySettings::min_stick_speed, 1e-9, 1e3, "m/s"},
    Setting{"tolerance", &FluidViscositySettings::tolerance, 1e-12, 0.5},
    Setting{"max_iterations", &FluidViscositySettings::max_iterations, 1, 1e6},
};
static_assert(setting_count<FluidViscositySettings> == member_count<FluidViscositySettings>(),
              "a setting is in no list");

/// Surface tension (src/physics/fluid/pressure/surface_tension.cpp).
struct FluidTensionSettings {
    /// Edge of cells from which on surface tension is left out, in capillary lengths √(σ/(ρ g)). Source: a curvature of
    /// one cell then has a quarter of gravity's pressure. Test: Settings.AreNoticed.
    double max_cell_size = 2;
    /// Weight of each neighbour where the density is smoothed along an axis. Source: 1 − 4 weights of a wave of two
    /// cells are left, a third; at 1/4 nothing holds such waves, and drops fall to pieces within seconds.
    float smoothing_weight = 1.0f / 6;
    /// Slope of the liquid's volume fraction, in 1/cells, below which there is no surface. Test: Settings.AreNoticed.
    float min_slope = 0.02f;
    /// Maximum curvature, in 1/cells. Source: a ball of two cells radius; the cells do not resolve smaller ones. Test:
    /// Settings.AreNoticed.
    float max_curvature = 1;
    /// Distance out of the surface, cells, from which on particles are drawn back. Test: Settings.AreNoticed.
    float stray_distance = 0.1f;
    /// Fraction of the distance beyond it by which a part of a step draws them back. Test: Settings.AreNoticed.
    float stray_rate = 0.2f;
    /// Slope of the liquid's volume fraction, in 1/cells, below which particles have no surface to be drawn to. Test:
    /// Settings.AreNoticed.
    float stray_min_slope = 0.01f;
};

template <>
inline constexpr auto settings_of<FluidTensionSettings> = std::tuple{
    Setting{"max_cell_size", &FluidTensionSettings::max_cell_size, 0, 1e3, "capillary lengths"},
    Setting{"smoothing_weight", &FluidTensionSettings::smoothing_weight, 0, 0.25},
    Setting{"min_slope", &FluidTensionSettings::min_slope, 1e-4, 10, "1/cells"},
    Setting{"max_curvature", &FluidTensionSettings::max_curvature, 0, 100, "1/cells"},
    Setting{"stray_distance", &FluidTensionSettings::stray_distance, 0, 2, "cells"},
    Setting{"stray_rate", &FluidTensionSettings::stray_rate, 0, 1},
    Setting{"stray_min_slope", &FluidTensionSettings::stray_min_slope, 1e-4, 10, "1/cells"},
};
static_assert(setting_count<FluidTensionSettings> == member_count<FluidTensionSettings>(), "a setting is in no list");

}  // namespace embody::physics
