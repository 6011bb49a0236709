// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

// Most pairs of the broad phase are apart. A pair without contacts is skipped until the travel of the two bodies since
// then, and their maximum travel in the step, add up to the gap that it had: a query reads two numbers of each pair and
// one of each body.

/// Synchronises the watches with the pairs of the broad phase, and with the contacts where others have changed them.
/// Contacts of pairs that are gone are dropped.
void update_watches(const TouchAccess& world);

/// Lists the pairs that can have contacts or wake a sleeper; while no body sleeps these are all.
void list_live_pairs(const TouchAccess& world);

/// Tells the touch stage of a body that was put into the slot. What is stored for pairs of the body before is invalid.
void introduce_body(const RigidState& rigid, std::uint32_t body, TouchMemory& memory);

/// Starts the step's motion of awake bodies: changes of contacts are measured from here on. Adds their travel since the
/// last start to their paths and finds their maximum travel in this step.
void start_motion(const TouchAccess& world);

/// Lists the pairs that must be looked at in this step: those with contacts and those that may get some.
void list_near_pairs(const TouchAccess& world);

/// Skips a pair without contacts until the travel of its bodies has reached `way` (m, sum of both).
void leave_alone(const TouchAccess& world, PairWatch& watch, double travel);

/// Calls visit(watch, its place) for each live pair, in their order.
template <class Visit>
void for_each_live_pair(const TouchAccess& world, Visit&& visit) {
    TouchMemory& memory = world.contacts.touch;
    if (world.activity.sleepers.empty()) {
        for (std::uint32_t i = 0; i < memory.watches.size(); ++i) visit(memory.watches[i], i);
    } else {
        for (const std::uint32_t i : memory.live) visit(memory.watches[i], i);
    }
}

}  // namespace embody::physics::stages
