// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/setting_list.h"
#include "physics/definitions/settings/solid_settings.h"
#include "physics/definitions/settings/thin_contact_settings.h"
#include "physics/definitions/settings/thin_settings.h"

namespace embody::physics {

/// When deformables fall asleep and wake (src/physics/stages/deformable/deformables.cpp).
/// OptimizationSettings::wake_force_fraction says when a change of their push wakes a body.
struct DeformableSleepSettings {
    /// Speed of all nodes below which a deformable may sleep, m/s. Source: Jolt's threshold for points of bodies is
    /// 0.03 m/s. Test: Settings.AreNoticed.
    double max_speed = 0.02;
    /// Displacement within which the nodes of a sheet or rope must stay instead, where contacts make it jitter, m.
    /// Test: Settings.AreNoticed.
    double max_displacement = 1e-3;
    /// Speed from which on a body or deformable wakes what is within its reach, m/s. Source: above max_speed, and as
    /// Box2D's sleep threshold of 0.05 m/s. Test: DeformableSleep.IsEndedByWhatPassesCloseNeitherSlowlyNorFarAway.
    double wake_speed = 0.05;
};

template <>
inline constexpr auto settings_of<DeformableSleepSettings> = std::tuple{
    Setting{"max_speed", &DeformableSleepSettings::max_speed, 0, 1e3, "m/s"},
    Setting{"max_displacement", &DeformableSleepSettings::max_displacement, 0, 1, "m"},
    Setting{"wake_speed", &DeformableSleepSettings::wake_speed, 0, 1e3, "m/s"},
};
static_assert(setting_count<DeformableSleepSettings> == member_count<DeformableSleepSettings>(),
              "a setting is in no list");

/// Solids, sheets and ropes (src/physics/deformable, stages/deformable).
struct DeformableSettings {
    SolidSettings solid;
    SolidContactSettings solid_contact;
    ClothSettings cloth;
    RopeSettings rope;
    ThinContactSettings thin_contact;
    ThinSearchSettings thin_search;
    DeformableSleepSettings sleep;
};

template <>
inline constexpr auto settings_of<DeformableSettings> = std::tuple{
    Setting{"solid", &DeformableSettings::solid},
    Setting{"solid_contact", &DeformableSettings::solid_contact},
    Setting{"cloth", &DeformableSettings::cloth},
    Setting{"rope", &DeformableSettings::rope},
    Setting{"thin_contact", &DeformableSettings::thin_contact},
    Setting{"thin_search", &DeformableSettings::thin_search},
    Setting{"sleep", &DeformableSettings::sleep},
};
static_assert(setting_count<DeformableSettings> == member_count<DeformableSettings>(), "a group is in no list");

}  // namespace embody::physics
