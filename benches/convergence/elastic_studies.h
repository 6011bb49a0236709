// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/result.h"

// Solids, sheets and ropes. Each is built, comes to rest or oscillates, and is measured at the given resolution.
namespace embody::convergence {

/// A beam of 1 × 0.1 × 0.1 m, clamped at one end, under its own weight.
inline constexpr double beam_youngs_modulus = 5e7, beam_poisson_ratio = 0.3, beam_density = 1000;  // Pa, 1, kg/m³
inline constexpr double beam_length = 1, beam_side = 0.1;                                          // m
/// Deflection of the beam's tip, m, with so many cells across.
Result<double> tip_of_beam(int cells);
/// Frequency of its first mode, Hz, 2 cells across, with so many steps per second (two substeps each).
Result<double> frequency_of_beam(int rate);

/// A stiff strip of cloth of 0.1 × 0.05 m: B = 0.01 N m, 0.1 kg/m².
inline constexpr double strip_length = 0.1, strip_bend_stiffness = 1e-2, strip_area_density = 0.1;
/// Deflection of its free end, m, with so many triangles along.
Result<double> tip_of_strip(int triangles);

/// A stiff rod of 1 m: EI = 10 N m², 0.1 kg/m.
inline constexpr double rod_length = 1, rod_rigidity = 10, rod_linear_density = 0.1;
/// Deflection of its free end, m, with so many segments.
Result<double> tip_of_rod(int segments);

/// A rope of 2.2 m that hangs over a span of 2 m.
inline constexpr double catenary_length = 2.2, catenary_span = 2;
/// Its sag, m, with so many segments (even).
Result<double> sag_of_rope(int segments);

/// A rope of 1 m in 40 segments that hangs from one end and oscillates with a small amplitude.
inline constexpr double hanging_length = 1;
/// Its longest period, s, with so many steps per second (two substeps each).
Result<double> period_of_rope(int rate);

}  // namespace embody::convergence
