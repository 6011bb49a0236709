// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "physics/definitions/settings/setting_list.h"

namespace embody::physics {

/// How many impacts are solved in a step, and how many bodies take part in one.
struct ImpactBudgetSettings {
    /// Impacts of one contact in a step that may bounce; later ones do not (Zeno's ball). Test: Settings.AreNoticed.
    int max_bounces = 3;
    /// Impacts of one contact in a step; then the contact solver stops it. Test: Settings.AreNoticed.
    int max_impacts = 5;
    /// Product of the restitutions of a body's impacts in a step below which hardly any speed is left of the first one:
    /// it bounces no more. Test: Settings.AreNoticed.
    double min_remaining_restitution = 0.05;
    /// Bounces against heaps in a step, of all bodies together: the collapse of a large heap of bouncing bodies has no
    /// end. Test: Settings.AreNoticed.
    std::size_t pile_bounces = 500;
    /// Awake bodies for each of which there is one more bounce against heaps. Test: Settings.AreNoticed.
    std::size_t bodies_per_pile_bounce = 8;
    /// Bodies and joints of jointed assemblies that cost as much as a bounce against a heap. Test:
    /// JointedImpact.ManyBlowsOnOneAssemblyReachALimitAndGainNothing.
    std::size_t nodes_per_bounce = 32;
    /// Predicted impacts that are looked at in a step, whatever the contacts. Test: Settings.AreNoticed.
    std::size_t base_events = 64;
    /// Predicted impacts besides, for each contact. Test: Settings.AreNoticed.
    std::size_t events_per_contact = 32;
    /// Sites of one collision beyond which no other contact joins in; what else collides has events of its own. Test:
    /// Settings.AreNoticed.
    std::size_t max_simultaneous_sites = 64;
    /// Share of a step by which impacts may be apart that are as simultaneous as mirror images. Source: rounding leaves
    /// 1e-12 between these. Test: Settings.AreNoticed.
    double simultaneous_fraction = 1e-6;
    /// Share of a step by which impacts on a heap may be apart that may change places. Test: Settings.AreNoticed.
    double pile_order_fraction = 0.02;
    /// Jointed bodies that an impact acts on in the same instant; farther ones learn of it from the substeps. Test:
    /// Settings.AreNoticed.
    std::size_t max_jointed_bodies = 64;
    /// Jointed bodies up to which an assembly is taken to the moment of its impact as the substeps will move it. Test:
    /// Settings.AreNoticed.
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
    Setting{"base_events", &ImpactBudgetSettings::base_events, 1, 1e9},
    Setting{"events_per_contact", &ImpactBudgetSettings::events_per_contact, 0, 1e6},
    Setting{"max_simultaneous_sites", &ImpactBudgetSettings::max_simultaneous_sites, 1, 1e6},
    Setting{"simultaneous_fraction", &ImpactBudgetSettings::simultaneous_fraction, 0, 1},
    Setting{"pile_order_fraction", &ImpactBudgetSettings::pile_order_fraction, 0, 1},
    Setting{"max_jointed_bodies", &ImpactBudgetSettings::max_jointed_bodies, 1, 256},
    Setting{"max_flown_bodies", &ImpactBudgetSettings::max_flown_bodies, 0, 256},
};
static_assert(setting_count<ImpactBudgetSettings> == member_count<ImpactBudgetSettings>(), "a setting is in no list");

}  // namespace embody::physics
