// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/node_stars.h"

#include <numeric>

namespace embody::physics::deformable {

template <std::size_t corners>
NodeStars::Lists NodeStars::lists_of(std::size_t nodes, std::span<const std::array<std::uint32_t, corners>> features) {
    Lists lists{.first = std::vector<std::uint32_t>(nodes + 1, 0), .items = {}};
    for (const auto& feature : features) {
        for (const std::uint32_t node : feature) ++lists.first[node + 1];
    }
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    lists.items.resize(lists.first.back());
    std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
    for (std::uint32_t f = 0; f < features.size(); ++f) {
        for (const std::uint32_t node : features[f]) lists.items[next[node]++] = f;
    }
    return lists;
}

NodeStars::NodeStars(std::size_t nodes, std::span<const std::array<std::uint32_t, 2>> edges,
                     std::span<const std::array<std::uint32_t, 3>> triangles)
    : edges_(lists_of(nodes, edges)), triangles_(lists_of(nodes, triangles)) {}

}  // namespace embody::physics::deformable
