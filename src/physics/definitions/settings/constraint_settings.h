// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/settings/contact_settings.h"
#include "physics/definitions/settings/direct_settings.h"
#include "physics/definitions/settings/impact_settings.h"
#include "physics/definitions/settings/joint_settings.h"
#include "physics/definitions/settings/rolling_settings.h"
#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Contacts, joints, impacts and rolling (src/physics/constraint and the stages that call it).
struct ConstraintSettings {
    ContactSettings contact;
    DirectSettings direct;
    JointSettings joint;
    ImpactSettings impact;
    RollingSettings rolling;
};

template <>
inline constexpr auto settings_of<ConstraintSettings> = std::tuple{
    Setting{"contact", &ConstraintSettings::contact}, Setting{"direct", &ConstraintSettings::direct},
    Setting{"joint", &ConstraintSettings::joint},     Setting{"impact", &ConstraintSettings::impact},
    Setting{"rolling", &ConstraintSettings::rolling},
};
static_assert(setting_count<ConstraintSettings> == member_count<ConstraintSettings>(), "a setting is in no list");

}  // namespace embody::physics
