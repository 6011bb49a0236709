// SPDX-License-Identifier: MIT
#include "physics/linear/nested_dissection.h"

#include <algorithm>
#include <tuple>

namespace embody::physics::linear {

namespace {

constexpr std::size_t largest_leaf = 12;  // nodes: as one dense front they cost less than another cut

class Dissector {
public:
    Dissector(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 2>> edges)
        : positions_(positions), neighbours_(positions.size()), side_(positions.size(), 0) {
        for (const auto [a, b] : edges) {
            neighbours_[a].push_back(b);
            neighbours_[b].push_back(a);
        }
        for (auto& list : neighbours_) {
            std::ranges::sort(list);
            list.erase(std::unique(list.begin(), list.end()), list.end());
        }
    }

    NestedDissection run() {
        result_.place.resize(positions_.size());
        std::vector<std::uint32_t> all(positions_.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        split(std::move(all));
        result_.front_of.resize(positions_.size());
        for (std::uint32_t f = 0; f < result_.fronts.size(); ++f) find_rows(f);
        return std::move(result_);
    }

private:
    // Orders `nodes` after all that was ordered before; the subtree's fronts end with the one of its separator.
    void split(std::vector<std::uint32_t> nodes) {
        if (nodes.empty()) return;
        if (nodes.size() <= largest_leaf) return add_front(std::move(nodes));
        const std::size_t half = nodes.size() / 2;
        sort_along_longest_side(nodes);

        // The separator: nodes of the upper half that have a neighbour in the lower half.
        ++mark_;
        for (std::size_t i = 0; i < half; ++i) side_[nodes[i]] = mark_;
        std::vector<std::uint32_t> lower(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(half)), upper,
            separator;
        for (std::size_t i = half; i < nodes.size(); ++i) {
            const auto& list = neighbours_[nodes[i]];
            const bool sees = std::ranges::any_of(list, [&](std::uint32_t other) { return side_[other] == mark_; });
            (sees ? separator : upper).push_back(nodes[i]);
        }
        split(std::move(lower));
        split(std::move(upper));
        add_front(std::move(separator));
    }

    void sort_along_longest_side(std::vector<std::uint32_t>& nodes) const {
        Vec3 low = positions_[nodes[0]], high = low;
        for (const std::uint32_t i : nodes) {
            low = min(low, positions_[i]);
            high = max(high, positions_[i]);
        }
        const Vec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::ranges::sort(nodes, {}, [&](std::uint32_t i) { return std::make_tuple(positions_[i][axis], i); });
    }

    void add_front(std::vector<std::uint32_t> nodes) {
        if (nodes.empty()) return;
        Front front;
        front.first = static_cast<std::uint32_t>(result_.node.size());
        for (const std::uint32_t i : nodes) {
            result_.place[i] = static_cast<std::uint32_t>(result_.node.size());
            result_.node.push_back(i);
        }
        front.last = static_cast<std::uint32_t>(result_.node.size());
        result_.fronts.push_back(std::move(front));
    }

    // Rows that the front reaches: neighbours of its own nodes and rows of its children, both after its own places. Its
    // parent is the front of the first of these rows, since that one is eliminated next.
    void find_rows(std::uint32_t index) {
        Front& front = result_.fronts[index];
        for (std::uint32_t place = front.first; place < front.last; ++place) {
            result_.front_of[place] = index;
            for (const std::uint32_t other : neighbours_[result_.node[place]]) {
                if (result_.place[other] >= front.last) front.rows.push_back(result_.place[other]);
            }
        }
        for (const std::uint32_t child : front.children) {
            for (const std::uint32_t place : result_.fronts[child].rows) {
                if (place >= front.last) front.rows.push_back(place);
            }
        }
        std::ranges::sort(front.rows);
        front.rows.erase(std::unique(front.rows.begin(), front.rows.end()), front.rows.end());
        for (const std::uint32_t child : front.children) place_in_parent(result_.fronts[child], front);
        front.parent = index;
        if (front.rows.empty()) return;
        while (result_.fronts[front.parent].last <= front.rows[0]) ++front.parent;
        result_.fronts[front.parent].children.push_back(index);
    }

    static void place_in_parent(Front& child, const Front& parent) {
        for (const std::uint32_t place : child.rows) {
            const auto row = std::ranges::lower_bound(parent.rows, place) - parent.rows.begin();
            child.in_parent.push_back(place < parent.last
                                          ? place - parent.first
                                          : static_cast<std::uint32_t>(parent.own() + static_cast<std::size_t>(row)));
        }
    }

    std::span<const Vec3> positions_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint32_t> side_;
    std::uint32_t mark_ = 0;
    NestedDissection result_;
};

}  // namespace

NestedDissection dissect(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 2>> edges) {
    return Dissector(positions, edges).run();
}

}  // namespace embody::physics::linear
