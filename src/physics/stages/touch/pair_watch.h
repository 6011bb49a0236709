// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

// Most pairs of the broad phase are apart. A pair that nothing is found of is left alone until the ways that the two
// bodies have gone since, and may go in the step, add up to the gap it had: whoever asks reads two numbers of each pair
// and one of each body.

/// Brings the watches in step with the pairs of the broad phase, and with the contacts where others have changed them.
/// Contacts of pairs that are gone are dropped.
void update_watches(const TouchAccess& world);

/// Lists the pairs that can have contacts or wake a sleeper; while no body sleeps these are all.
void list_live_pairs(const TouchAccess& world);

/// Tells the touch stage of a body that was put into the slot. What pairs know of the one before does not hold.
void introduce_body(const RigidState& rigid, std::uint32_t body, TouchMemory& memory);

/// The step's motion of awake bodies starts here: how contacts change is told from here on. Adds the way since the last
/// start to their paths and tells how far they may go in this step.
void start_motion(const TouchAccess& world);

/// Lists the pairs that must be looked at in this step: those with contacts and those that may get some.
void list_near_pairs(const TouchAccess& world);

/// Leaves a pair without contacts alone until its bodies have gone `way` (m, of both together).
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
