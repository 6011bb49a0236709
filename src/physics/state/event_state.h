// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <vector>

#include "physics/definitions/events.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// Two touching bodies as the contact events know them.
struct TouchingPair {
    BodyHandle a, b;
    friend auto operator<=>(const TouchingPair&, const TouchingPair&) = default;
};

/// What users read about a step after it.
struct EventState {
    std::vector<TouchingPair> touching;       // report, wake: awake pairs that touch, sorted
    std::vector<TouchingPair> touching_now;   // report: memory only
    std::vector<ContactEvent> contacts;       // report
    std::vector<RopeBreakEvent> rope_breaks;  // deformables
    std::vector<BodyBreakEvent> body_breaks;  // face
    std::vector<SheetTearEvent> sheet_tears;  // face
    std::vector<SleepEvent> sleep;            // wake, sleep
};

}  // namespace embody::physics::state
