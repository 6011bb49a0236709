// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "physics/constraint/contact/contact.h"
#include "physics/optimization/island_sleep.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// An island that sleeps: its bodies and the contacts that it fell asleep with.
struct SleepingGroup {
    std::vector<std::uint32_t> bodies;
    std::vector<Contact> contacts;
};

/// Which bodies are awake and which sleep.
struct ActivityState {
    std::vector<SleepRecord> sleep;                   // sleep, wake: by slot
    std::vector<std::uint32_t> awake;                 // wake: slots of moving bodies, ascending
    std::uint32_t asleep_when_gathered = 0;           // wake: dynamic bodies that slept when awake was listed
    bool awake_changed = true;                        // face, wake, substeps, sleep: awake must be listed anew
    std::uint64_t awake_version = 0;                  // wake: counts the lists of awake
    std::vector<std::uint32_t> movable;               // islands: awake ones that impulses move; memory only
    std::map<std::uint32_t, SleepingGroup> sleepers;  // sleep, wake
    std::uint32_t next_group = 1;                     // face, sleep
    std::vector<std::uint32_t> to_wake;               // face, touch, deformables: slots

    [[nodiscard]] bool is_asleep(std::uint32_t body) const { return sleep[body].state == SleepState::asleep; }
};

}  // namespace embody::physics::state
