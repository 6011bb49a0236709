// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Contact regions and the sweeps over them (src/physics/constraint/contact, sweeps).
struct ContactSettings {
    /// Distance up to which a new point takes over the impulses of an old one of another feature, m. Source: Jolt takes
    /// 0.01 (mContactPointPreserveLambdaMaxDistSq), Bullet 0.02 of the smaller body's reach
    /// (gContactBreakingThreshold). Test: Settings.AreNoticed.
    double match_reach = 0.02;
    /// The same distance for points of one feature, over match_reach: the feature identifies the point wherever it
    /// slides. Test: Settings.AreNoticed.
    double match_feature_ratio = 5;
    /// Depth from which on a step reports that bodies overlap deeply, m; it steers nothing else. Source: what
    /// max_correction_speed takes out in a step of 1/60 s. Test: Extremes.DeepOverlapsAreReported.
    float deep_penetration = 0.05F;
    /// Depth beyond the sag of a loaded soft contact that is not corrected, m. Source: less than the 0.005 of Box2D 2.4
    /// (b2_linearSlop) and the 0.02 of Jolt (mPenetrationSlop); here contacts are kept whatever their depth. Test:
    /// Settings.AreNoticed.
    double penetration_slop = 1e-4;
    /// Fraction of a penetration that is corrected a second, 1/s. At a larger rate a chair's foot that was found too
    /// deep kicks the chair up. Test: Settings.AreNoticed.
    double recovery_rate = 10;
    /// Maximum speed at which overlapping bodies are separated, m/s; for all contact solvers. Source: Box2D 3's speed
    /// of 3 m/s for the same. Test: Settings.AreNoticed.
    double max_correction_speed = 3;
    /// Number of contacts up to which a list is short: a short list takes the world's substeps and more passes. Test:
    /// Settings.AreNoticed.
    std::size_t long_list_contacts = 64;
    /// Substeps of a long list, over those of the world. Source: measured, docs/physics/contact-solver.md; the method
    /// is of M. Macklin et al., "Small steps in physics simulation", 2019. Test: Settings.AreNoticed.
    int long_list_substeps = 2;
    /// Passes over a long list in each phase of a substep. Source: Macklin et al. 2019, one iteration a substep. Test:
    /// Settings.AreNoticed.
    int long_list_passes = 1;
    /// Passes over a short list. Test: Settings.AreNoticed.
    int short_list_passes = 2;
    /// Passes over a short list of contacts among joints, whose substeps stay those of the world. Test:
    /// Settings.AreNoticed.
    int jointed_passes = 8;
    /// Frequency of the soft contacts of a long list over that of its substeps: the maximum at which one pass
    /// converges. Source: Box2D 3.1.1 bounds it by 1/8 between moving bodies and by 1/4 on static ones. Test:
    /// Settings.AreNoticed.
    double long_list_stiffness = 0.15;
    /// The same for a short list, where two passes converge. Test: Settings.AreNoticed.
    double short_list_stiffness = 0.3;
    /// The same for a short list among joints, where more passes converge. Test: Settings.AreNoticed.
    double jointed_stiffness = 0.5;
};

template <>
inline constexpr auto settings_of<ContactSettings> = std::tuple{
    Setting{"match_reach", &ContactSettings::match_reach, 0, 1, "m"},
    Setting{"match_feature_ratio", &ContactSettings::match_feature_ratio, 0, 1000},
    Setting{"deep_penetration", &ContactSettings::deep_penetration, 1e-6, 1000, "m"},
    Setting{"penetration_slop", &ContactSettings::penetration_slop, 0, 0.1, "m"},
    Setting{"recovery_rate", &ContactSettings::recovery_rate, 0.01, 1e4, "1/s"},
    Setting{"max_correction_speed", &ContactSettings::max_correction_speed, 1e-3, 1000, "m/s"},
    Setting{"long_list_contacts", &ContactSettings::long_list_contacts, 0, 1e9},
    Setting{"long_list_substeps", &ContactSettings::long_list_substeps, 1, 16},
    Setting{"long_list_passes", &ContactSettings::long_list_passes, 1, 1000},
    Setting{"short_list_passes", &ContactSettings::short_list_passes, 1, 1000},
    Setting{"jointed_passes", &ContactSettings::jointed_passes, 1, 1000},
    Setting{"long_list_stiffness", &ContactSettings::long_list_stiffness, 1e-3, 1},
    Setting{"short_list_stiffness", &ContactSettings::short_list_stiffness, 1e-3, 1},
    Setting{"jointed_stiffness", &ContactSettings::jointed_stiffness, 1e-3, 1},
};
static_assert(setting_count<ContactSettings> == member_count<ContactSettings>(), "a setting is in no list");

}  // namespace embody::physics
