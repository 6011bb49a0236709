// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// How one collision of several sites is solved (src/physics/constraint/impact).
struct ImpactSolverSettings {
    /// Step of integration in a first compression, over the time of the fastest decay of the sliding. Source:
    /// Runge-Kutta of order 4 is wrong by about x⁵/120 a step, 8e-6. Test: Settings.AreNoticed.
    double step_fraction = 0.25;
    /// Fraction of a step within which the end of that compression is found. Test: Settings.AreNoticed.
    double end_fraction = 1e-6;
    /// Sliding speed that counts as none, over the speed of approach; after a first compression. Test:
    /// Settings.AreNoticed.
    double slide_tolerance = 1e-5;
    /// step_fraction of later compressions, which change little, and of piles. Test: Settings.AreNoticed.
    double rough_step_fraction = 0.5;
    /// end_fraction of later compressions and of piles. Test: Settings.AreNoticed.
    double rough_end_fraction = 1e-3;
    /// slide_tolerance of later compressions and of piles. Test: Settings.AreNoticed.
    double rough_slide_tolerance = 1e-3;
    /// step_fraction of the expansion of a site that collides alone. Source: as above, 8e-8 a step. Test:
    /// Settings.AreNoticed.
    double expansion_step_fraction = 0.1;
    /// end_fraction of that expansion: to the last digits, so that a body that bounces without friction keeps its
    /// energy. Test: Settings.AreNoticed.
    double expansion_end_fraction = 1e-13;
    /// Cosine of a slide's turn in a first compression above which the slide is taken along its mean direction. Test:
    /// Settings.AreNoticed.
    double straight_cosine = 0.9;
    /// The same cosine in later compressions. Test: Settings.AreNoticed.
    double straight_cosine_later = 0.5;
    /// Maximum speed of approach that compression leaves, over the fastest approach at the start. Test:
    /// Settings.AreNoticed.
    double approach_tolerance = 1e-4;
    /// The same speed for many sites and for piles: the substeps stop what is left. Test: Settings.AreNoticed.
    double rough_approach_tolerance = 1e-2;
    /// Number of sites above which they count as many. Test: Settings.AreNoticed.
    std::size_t rough_sites = 8;
    /// Maximum compressions of one collision, however few its sites. Test: Settings.AreNoticed.
    std::size_t base_iterations = 64;
    /// Further compressions for each site. Test: Settings.AreNoticed.
    std::size_t iterations_per_site = 64;
};

template <>
inline constexpr auto settings_of<ImpactSolverSettings> = std::tuple{
    Setting{"step_fraction", &ImpactSolverSettings::step_fraction, 0.01, 0.5},
    Setting{"end_fraction", &ImpactSolverSettings::end_fraction, 1e-15, 0.1},
    Setting{"slide_tolerance", &ImpactSolverSettings::slide_tolerance, 0, 0.1},
    Setting{"rough_step_fraction", &ImpactSolverSettings::rough_step_fraction, 0.01, 0.5},
    Setting{"rough_end_fraction", &ImpactSolverSettings::rough_end_fraction, 1e-15, 0.1},
    Setting{"rough_slide_tolerance", &ImpactSolverSettings::rough_slide_tolerance, 0, 0.1},
    Setting{"expansion_step_fraction", &ImpactSolverSettings::expansion_step_fraction, 0.01, 0.5},
    Setting{"expansion_end_fraction", &ImpactSolverSettings::expansion_end_fraction, 1e-15, 0.1},
    Setting{"straight_cosine", &ImpactSolverSettings::straight_cosine, -1, 1},
    Setting{"straight_cosine_later", &ImpactSolverSettings::straight_cosine_later, -1, 1},
    Setting{"approach_tolerance", &ImpactSolverSettings::approach_tolerance, 1e-12, 0.5},
    Setting{"rough_approach_tolerance", &ImpactSolverSettings::rough_approach_tolerance, 1e-12, 0.5},
    Setting{"rough_sites", &ImpactSolverSettings::rough_sites, 0, 1e6},
    Setting{"base_iterations", &ImpactSolverSettings::base_iterations, 1, 1e6},
    Setting{"iterations_per_site", &ImpactSolverSettings::iterations_per_site, 0, 1e6},
};
static_assert(setting_count<ImpactSolverSettings> == member_count<ImpactSolverSettings>(), "a setting is in no list");

}  // namespace embody::physics
