// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec3.h"
#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// A piece of a graph that is eliminated at once: a separator, or the nodes that separators leave.
struct Front {
    std::uint32_t first = 0, last = 0;     ///< places in the order of elimination: its own, from first to last - 1
    std::uint32_t parent = 0;              ///< next front to be eliminated that it reaches; itself: none
    std::vector<std::uint32_t> rows;       ///< places after its own that it reaches, ascending
    std::vector<std::uint32_t> in_parent;  ///< for each of `rows`: which of the parent's own and rows it is
    std::vector<std::uint32_t> children;   ///< fronts, ascending
    [[nodiscard]] std::size_t own() const { return last - first; }
    [[nodiscard]] std::size_t size() const { return own() + rows.size(); }
};

/// An order in which the nodes of a mesh are eliminated with little fill: halves first, then what lies between them
/// (A. George, "Nested dissection of a regular finite element mesh", 1973), cut across the longest side at the median.
struct NestedDissection {
    std::vector<std::uint32_t> place;     ///< by node
    std::vector<std::uint32_t> node;      ///< by place
    std::vector<Front> fronts;            ///< children before their parent
    std::vector<std::uint32_t> front_of;  ///< by place
};

/// `edges` join nodes; an edge may be repeated, its two ends differ.
NestedDissection dissect(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 2>> edges);

}  // namespace embody::physics::linear
