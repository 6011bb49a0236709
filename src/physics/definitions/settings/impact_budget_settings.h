// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// Limits of the number of impacts solved in a step, and of the bodies in one impact.
struct ImpactBudgetSettings {
    /// Maximum number of bouncing impacts of one contact in a step; later ones do not bounce (Zeno's ball). Test:
    /// Settings.AreNoticed.
    int max_bounces = 3;
    /// Maximum number of impacts of one contact in a step; after these the contact solver stops it. Test:
    /// Settings.AreNoticed.
    int max_impacts = 5;
    /// Product of the restitutions of a body's impacts in a step below which hardly any of the first speed is left: the
    /// body bounces no more. Test: Settings.AreNoticed.
    double min_remaining_restitution = 0.05;
    /// Maximum number of bounces against piles in a step, of all bodies together: the collapse of a large pile of
    /// bouncing bodies has no end. Test: Settings.AreNoticed.
    std::size_t pile_bounces = 500;
    /// Number of awake bodies for which one more bounce against piles is allowed. Test:
    /// ImpactBudget.OfPilesGrowsWithTheAwakeBodies.
    std::size_t bodies_per_pile_bounce = 8;
    /// Number of bodies and joints of jointed assemblies that cost as much as a bounce against a pile. Test:
    /// JointedImpact.ManyBlowsOnOneAssemblyReachALimitAndGainNothing.
    std::size_t nodes_per_bounce = 32;
    /// Predicted impacts for each contact that may be handled in a step, of all contacts together. Test:
    /// ImpactBudget.LetsEachContactHaveAllItsBounces.
    std::size_t events_per_contact = 32;
    /// Number of sites of one collision beyond which no other contact is added; further contacts have events of their
    /// own. Test: Settings.AreNoticed.
    std::size_t max_simultaneous_sites = 64;
    /// Fraction of a step within which impacts are simultaneous. Source: rounding leaves 1e-12 between mirror images.
    /// Test: Settings.AreNoticed.
    double simultaneous_fraction = 1e-6;
    /// Fraction of a step within which impacts on a pile may change their order. Test: Settings.AreNoticed.
    double pile_order_fraction = 0.02;
    /// Maximum number of jointed bodies that an impact acts on in the same instant; the substeps pass it on to farther
    /// ones. Test: Settings.AreNoticed.
    std::size_t max_jointed_bodies = 64;
    /// Number of jointed bodies up to which an assembly is moved to the moment of its impact as the substeps will move
    /// it. Test: Settings.AreNoticed.
    std::size_t max_flown_bodies = 8;
};

template <>
inline constexpr auto settings_of<ImpactBudgetSettings> = std::tuple{
    Setting{"max_bounces", &ImpactBudgetSettings::max_bounces, 0, 200},
    Setting{"max_impacts", &ImpactBudgetSettings::max_impacts, 1, 200},
    Setting{"min_remaining_restitution", &ImpactBudgetSettings::min_remaining_restitution, 0, 1},
    Setting{"pile_bounces", &ImpactBudgetSettings::pile_bounces, 1, 1e9},
    Setting{"bodies_per_pile_bounce", &ImpactBudgetSettings::bodies_per_pile_bounce, 1, 1e9},
    Setting{"nodes_per_bounce", &ImpactBudgetSettings::nodes_per_bounce, 1, 1e9},
    Setting{"events_per_contact", &ImpactBudgetSettings::events_per_contact, 1, 1e6},
    Setting{"max_simultaneous_sites", &ImpactBudgetSettings::max_simultaneous_sites, 1, 1e6},
    Setting{"simultaneous_fraction", &ImpactBudgetSettings::simultaneous_fraction, 0, 1},
    Setting{"pile_order_fraction", &ImpactBudgetSettings::pile_order_fraction, 0, 1},
    Setting{"max_jointed_bodies", &ImpactBudgetSettings::max_jointed_bodies, 1, 256},
    Setting{"max_flown_bodies", &ImpactBudgetSettings::max_flown_bodies, 0, 256},
};
static_assert(setting_count<ImpactBudgetSettings> == member_count<ImpactBudgetSettings>(), "a setting is in no list");

}  // namespace embody::physics
