// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/contact/contact.h"
#include "physics/optimization/namespace.h"

namespace embody::physics::optimization {

/// The order in which contacts are solved, and the contacts that are solved at once (docs/physics/wide-solver.md).
struct SolveSchedule {
    /// Contacts of different movable bodies, solved by one instruction each.
    struct Batch {
        std::uint32_t first = 0;             ///< into `contacts`
        std::uint8_t count = 0, points = 0;  ///< number of contacts; maximum of their points
    };
    /// Batches that touch different movable bodies: any order, on any thread, gives the same result.
    struct Stage {
        std::uint32_t first_batch = 0, batch_count = 0;
    };
    std::vector<std::uint32_t> contacts;  ///< batch by batch
    std::vector<Batch> batches;           ///< stage by stage
    std::vector<Stage> stages;            ///< in the order of the sweep upwards

    // Scratch of build_schedule; members only to keep its memory.
    std::vector<std::uint32_t> stage_of, first_of_key;
    std::vector<std::uint64_t> colours;
};

/// `order`: contacts from the ground up. Arrays over bodies are indexed by slot. Equal inputs give equal schedules, and
/// the solution does not depend on `lanes`.
void build_schedule(std::span<const std::uint32_t> order, std::span<const ContactSummary> contacts,
                    std::span<const BodyState> bodies, int lanes, SolveSchedule& schedule);

}  // namespace embody::physics::optimization
