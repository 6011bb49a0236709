// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Edges and triangles around each node of a sheet, by their numbers, rising.
class NodeStars {
public:
    NodeStars() = default;
    NodeStars(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges,
              std::span<const std::array<std::uint32_t, 3>> triangles);

    [[nodiscard]] std::span<const std::uint32_t> edges(std::uint32_t node) const { return edges_.around(node); }
    [[nodiscard]] std::span<const std::uint32_t> triangles(std::uint32_t node) const { return triangles_.around(node); }

private:
    struct Lists {
        std::vector<std::uint32_t> first, items;  // of node i: those from first[i] to first[i + 1]
        [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t node) const {
            return std::span(items).subspan(first[node], first[node + 1] - first[node]);
        }
    };
    template <std::size_t corners>
    static Lists lists_of(std::size_t nodes, std::span<const std::array<std::uint32_t, corners>> features);

    Lists edges_, triangles_;
};

}  // namespace embody::physics::deformable
