// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/constraint/contact/contact.h"
#include "physics/constraint/joint/joint.h"
#include "physics/optimization/namespace.h"

namespace embody::physics::optimization {

/// Bodies that constraints connect, directly or through other movable bodies. Ranges into the arrays of Islands.
struct Island {
    std::uint32_t first_body = 0, body_count = 0;
    std::uint32_t first_contact = 0, contact_count = 0;
    std::uint32_t first_joint = 0, joint_count = 0;
    std::uint32_t deepest_level = 0;  ///< levels of the contact graph above the ground
};

/// The graph that islands are cut from.
struct ContactGraph {
    using Ends = std::array<std::uint32_t, 2>;
    std::vector<std::uint32_t> bodies;   ///< movable ones
    std::vector<Ends> contacts, joints;  ///< 0xFFFFFFFF: one end of joints with the world, both ends of idle contacts
    friend bool operator==(const ContactGraph&, const ContactGraph&) = default;
};

/// The contact graph cut into islands, and the order in which each island is solved: from the ground up. Equal inputs
/// give equal orders.
struct Islands {
    std::vector<Island> list;
    std::vector<std::uint32_t> bodies;    ///< slots, island by island, ascending
    std::vector<std::uint32_t> contacts;  ///< indices, island by island, lowest level first
    std::vector<std::uint32_t> joints;    ///< indices, island by island
    std::vector<std::uint32_t> level;     ///< by body slot: steps through contacts to an immovable body; 0 is immovable
    ContactGraph graph, last_graph;       ///< the graph that this was built from, and the one before: memory only

    /// Memory of the search, so that a changing graph allocates nothing. By slot, but `neighbour` by contact.
    struct Memory {
        std::vector<std::uint32_t> parent, island_of_root, first, next, neighbour, front;
    };
    Memory memory;
};

inline constexpr std::uint32_t no_level = 0xFFFFFFFFu;  ///< hangs in the air

/// `awake` lists the movable bodies, ascending; every contact and joint must touch at least one of them. The islands
/// stay as they are while the graph is the one that they were built from.
void build_islands(std::span<const std::uint32_t> awake, std::span<const BodyState> bodies,
                   std::span<const ContactSummary> contacts, std::span<const Joint> joints, Islands& islands);

}  // namespace embody::physics::optimization
