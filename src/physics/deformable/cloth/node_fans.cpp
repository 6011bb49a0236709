// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/node_fans.h"

#include <algorithm>

namespace embody::physics::deformable {

NodeFans::NodeFans(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t nodes)
    : start_(nodes + 1, 0), wedges_(3 * triangles.size()) {
    for (const auto& triangle : triangles) {
        for (const std::uint32_t node : triangle) ++start_[node + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) start_[i + 1] += start_[i];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k)
            wedges_[next[triangles[t][k]]++] = {t, k, {triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]}};
    }
}

std::vector<NodeFan> NodeFans::around(std::uint32_t node, std::span<const SheetEdge> cut) const {
    const std::span<const Wedge> all = wedges(node);
    constexpr std::size_t none = ~std::size_t{0};
    bool is_manifold = true;
    // The wedge on the other side of one's edge; none at a hem or a cut.
    const auto across = [&](std::size_t own, std::uint32_t spoke) {
        std::size_t found = none;
        for (std::size_t w = 0; w < all.size(); ++w) {
            if (w == own || (all[w].spoke[0] != spoke && all[w].spoke[1] != spoke)) continue;
            is_manifold = is_manifold && found == none;
            found = w;
        }
        return std::ranges::binary_search(cut, edge_between(node, spoke)) ? none : found;
    };
    const auto other = [&](std::size_t w, std::uint32_t spoke) {
        return all[w].spoke[0] == spoke ? all[w].spoke[1] : all[w].spoke[0];
    };

    std::vector<std::uint8_t> is_known(all.size(), 0);
    std::vector<NodeFan> fans;
    for (std::size_t w = 0; w < all.size(); ++w) {
        if (is_known[w] != 0) continue;
        // Back to where the fan begins, or once around.
        std::size_t first = w;
        std::uint32_t spoke = all[w].spoke[0];
        for (std::size_t back = across(first, spoke); back != none && back != w && is_manifold;
             back = across(first, spoke)) {
            spoke = other(back, spoke);
            first = back;
        }
        NodeFan fan{{}, {spoke}};
        for (std::size_t at = first; at != none && is_known[at] == 0 && is_manifold; at = across(at, spoke)) {
            is_known[at] = 1;
            fan.triangles.push_back(all[at].triangle);
            spoke = other(at, spoke);
            fan.spokes.push_back(spoke);
        }
        fans.push_back(std::move(fan));
    }
    return is_manifold ? fans : std::vector<NodeFan>();
}

std::vector<std::uint32_t> NodeFans::triangles_of(std::uint32_t node) const {
    std::vector<std::uint32_t> triangles;
    for (const Wedge& wedge : wedges(node)) triangles.push_back(wedge.triangle);
    return triangles;
}

std::vector<TornCorner> NodeFans::split(std::vector<SheetEdge> cut, std::span<const std::uint8_t> held,
                                        std::span<const std::uint32_t> loose) const {
    std::ranges::sort(cut);
    std::vector<std::uint32_t> ends(loose.begin(), loose.end());
    for (const auto& [low, high] : cut) ends.insert(ends.end(), {low, high});
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    auto next = static_cast<std::uint32_t>(node_count());
    std::vector<TornCorner> torn;
    for (const std::uint32_t node : ends) {
        if (!held.empty() && held[node] != 0) continue;
        const std::vector<NodeFan> fans = around(node, cut);
        for (std::size_t f = 1; f < fans.size(); ++f, ++next) {
            for (const std::uint32_t triangle : fans[f].triangles) {
                const auto wedge = std::ranges::find(wedges(node), triangle, &Wedge::triangle);
                torn.push_back({3 * triangle + wedge->corner, node, next});
            }
        }
    }
    return torn;
}

}  // namespace embody::physics::deformable
