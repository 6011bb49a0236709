// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Gaps up to which surfaces are looked for, how long contacts follow their bodies before they are found anew, and how
/// fast bodies are stopped (src/physics/stages/touch, stages/rigid/continuous.cpp). The tolerances of src/geometry
/// stand where they are used.
struct CollisionSettings {
    /// Gap up to which surfaces are looked for besides what they can close in the step, m. Source: less than the 0.02
    /// of Box2D 3 (B2_SPECULATIVE_DISTANCE) and Jolt (mSpeculativeContactDistance), which add no travel. Test:
    /// Settings.AreNoticed.
    double contact_margin = 0.005;
    /// The same gap for balls, in radii: their one point of contact does not jump, and with an absolute gap most
    /// contacts of grains of millimetres would be with grains that they do not touch. Grains that fall together 0.1
    /// diameters apart must see each other before the first of them is stopped. Test: Settings.AreNoticed, GrainSilo.
    double ball_margin_fraction = 0.2;
    /// Travel of a pair up to which its contacts follow it, m: they hold each corner within contact_margin plus this.
    /// Test: Settings.AreNoticed.
    double follow_travel = 0.0025;
    /// The same travel where corners had to be left out, m: those corners sink undetected. Test: Settings.AreNoticed.
    double follow_travel_partial = 1e-3;
    /// The same travel for a rolling body, m: its point of contact does not stay on it; after so short a travel the gap
    /// is right to a hundredth of the travel. Test: Settings.AreNoticed.
    double follow_travel_round = 2e-5;
    /// Cosine between normals above which a contact with another triangle goes on from an old one of the same body.
    /// Test: Settings.AreNoticed.
    double same_normal_cosine = 0.98;
    /// Reach of the points of a rolling contact, over the body's reach: farther points of the rim would move the anchor
    /// of friction up to the axle. Test: Settings.AreNoticed.
    double rim_reach_fraction = 0.1;
    /// Gap at which an approaching body wakes a sleeper, m. Test: Settings.AreNoticed.
    double wake_gap = 1e-4;
    /// Gap that continuous collision leaves, m: the contact solver takes smaller gaps. Source: below contact_margin.
    /// Test: Settings.AreNoticed.
    double continuous_gap = 1e-3;
    /// Travel in a step, over its inner radius, up to which a body marked continuous is not swept; for other bodies it
    /// is 1. Test: Settings.AreNoticed.
    double continuous_travel_fraction = 0.25;
    /// Depth, over its inner radius, to which a body that slides along an obstacle may sink before it is stopped. Test:
    /// Settings.AreNoticed.
    double continuous_slide_fraction = 0.25;
    /// Half the turn in a step below which contacts follow a body's ends by themselves, rad. Test:
    /// Continuous.a_spinning_rod_does_not_pass_a_thin_wall.
    double continuous_half_turn = 0.125;
};

template <>
inline constexpr auto settings_of<CollisionSettings> = std::tuple{
    Setting{"contact_margin", &CollisionSettings::contact_margin, 1e-6, 1, "m"},
    Setting{"ball_margin_fraction", &CollisionSettings::ball_margin_fraction, 1e-3, 10},
    Setting{"follow_travel", &CollisionSettings::follow_travel, 0, 0.0025, "m"},
    Setting{"follow_travel_partial", &CollisionSettings::follow_travel_partial, 0, 0.0025, "m"},
    Setting{"follow_travel_round", &CollisionSettings::follow_travel_round, 0, 0.0025, "m"},
    Setting{"same_normal_cosine", &CollisionSettings::same_normal_cosine, -1, 1},
    Setting{"rim_reach_fraction", &CollisionSettings::rim_reach_fraction, 0, 1},
    Setting{"wake_gap", &CollisionSettings::wake_gap, 0, 1, "m"},
    Setting{"continuous_gap", &CollisionSettings::continuous_gap, 1e-6, 1, "m"},
    Setting{"continuous_travel_fraction", &CollisionSettings::continuous_travel_fraction, 1e-3, 1},
    Setting{"continuous_slide_fraction", &CollisionSettings::continuous_slide_fraction, 0, 1},
    Setting{"continuous_half_turn", &CollisionSettings::continuous_half_turn, 0, 1, "rad"},
};
static_assert(setting_count<CollisionSettings> == member_count<CollisionSettings>(), "a setting is in no list");

}  // namespace embody::physics
