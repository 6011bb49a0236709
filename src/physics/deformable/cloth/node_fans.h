// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/deformable/cloth/cloth_mesh.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Triangles around a node, each with an edge in common with the next.
struct NodeFan {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t>
        spokes;  ///< other ends of the edges at the node: before, between and after the triangles
    [[nodiscard]] bool is_closed() const { return spokes.front() == spokes.back(); }
};

/// The triangles around each node of a sheet.
class NodeFans {
public:
    NodeFans() = default;
    NodeFans(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t nodes);

    [[nodiscard]] std::size_t node_count() const { return start_.empty() ? 0 : start_.size() - 1; }
    /// Fans of the node, apart at hems and at the cut edges, which are sorted. None where an edge has more than two
    /// triangles.
    [[nodiscard]] std::vector<NodeFan> around(std::uint32_t node, std::span<const SheetEdge> cut = {}) const;
    /// Triangles around the node, ascending.
    [[nodiscard]] std::vector<std::uint32_t> triangles_of(std::uint32_t node) const;
    /// What comes apart by these cuts, in any order: of each of their ends that is not held, and of the `loose` nodes,
    /// every fan but the first gets a new node, numbered on from the nodes that there are. `held`: by node, or none.
    [[nodiscard]] std::vector<TornCorner> split(std::vector<SheetEdge> cut, std::span<const std::uint8_t> held,
                                                std::span<const std::uint32_t> loose = {}) const;

private:
    // The triangle's corner at the node, and its other two.
    struct Wedge {
        std::uint32_t triangle = 0, corner = 0;
        std::array<std::uint32_t, 2> spoke{};
    };
    [[nodiscard]] std::span<const Wedge> wedges(std::uint32_t node) const {
        return std::span(wedges_).subspan(start_[node], start_[node + 1] - start_[node]);
    }

    std::vector<std::uint32_t> start_;
    std::vector<Wedge> wedges_;  // by node
};

}  // namespace embody::physics::deformable
